#include "cli/child_process.hpp"

#include <cerrno>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>
#include <utility>

#include "cli/console.hpp"
#include "quadedge/error.hpp"

namespace quadedge::cli {
namespace {

constexpr int kCannotStart = 127;  // exit code of a child that never became the program

/// What the child does until it is another program; only calls that are safe after a fork.
[[noreturn]] void become(char* const* arguments, char* const* environment, int log, pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  setpgid(0, 0);  // a terminal's Ctrl-C is for the parent, which then ends its children in good order
  if (getppid() != parent) _exit(kCannotStart);  // the parent died before the line above
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  const int input = open("/dev/null", O_RDONLY);
  dup2(input, STDIN_FILENO);
  dup2(log, STDOUT_FILENO);
  dup2(log, STDERR_FILENO);
  execve(kProgramFile, arguments, environment);
  _exit(kCannotStart);
}

}  // namespace

ChildProcess::ChildProcess(const std::vector<std::string>& arguments, const std::string& log,
                           const std::string& error) {
  std::vector<char*> pointers = {const_cast<char*>("quadedge")};
  for (const auto& argument : arguments) pointers.push_back(const_cast<char*>(argument.c_str()));
  pointers.push_back(nullptr);
  std::string variable = std::string(kErrorFile) + "=" + error;
  std::vector<char*> environment = {variable.data()};
  for (char** entry = environ; *entry != nullptr; ++entry) environment.push_back(*entry);
  environment.push_back(nullptr);
  const int file = open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_APPEND | O_CLOEXEC, 0666);
  if (file < 0) throw DataError(log + ": cannot be made: " + std::strerror(errno));
  const pid_t parent = getpid();
  process_ = fork();
  if (process_ == 0) become(pointers.data(), environment.data(), file, parent);
  const int reason = errno;
  close(file);
  if (process_ < 0) throw Error(ExitCode::internal, std::string("no process can be started: ") + std::strerror(reason));
}

ChildProcess::ChildProcess(ChildProcess&& other) noexcept : process_(std::exchange(other.process_, -1)) {}

ChildProcess& ChildProcess::operator=(ChildProcess&& other) noexcept {
  std::swap(process_, other.process_);
  return *this;
}

ChildProcess::~ChildProcess() {
  if (process_ < 0) return;
  kill(process_, SIGKILL);
  waitpid(process_, nullptr, 0);
}

std::optional<ChildEnd> ChildProcess::ended() {
  int status = 0;
  if (process_ < 0 || waitpid(process_, &status, WNOHANG) != process_) return std::nullopt;
  process_ = -1;
  if (WIFSIGNALED(status)) return ChildEnd{static_cast<int>(ExitCode::internal), WTERMSIG(status)};
  return ChildEnd{WEXITSTATUS(status), 0};
}

void ChildProcess::terminate() const {
  if (process_ >= 0) kill(process_, SIGTERM);
}

}  // namespace quadedge::cli
