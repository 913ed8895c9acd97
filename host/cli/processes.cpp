#include "cli/processes.hpp"

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <spawn.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>
#include <utility>

#include "cli/console.hpp"
#include "quadedge/error.hpp"

namespace quadedge::cli {
namespace {

volatile std::sig_atomic_t received = 0;  // a signal handler can reach nothing but a global variable

void note_signal(int number) { received = number; }

}  // namespace

Interruption::Interruption() {
  received = 0;
  struct sigaction action {};
  action.sa_handler = note_signal;
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  sigemptyset(&action.sa_mask);
  for (std::size_t i = 0; i < kSignals.size(); ++i) {
    sigaction(kSignals[i], nullptr, &before_[i]);
    if (before_[i].sa_handler != SIG_IGN) sigaction(kSignals[i], &action, nullptr);
  }
}

Interruption::~Interruption() {
  for (std::size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], &before_[i], nullptr);
}

int Interruption::signal() const { return received; }

void Interruption::end_process() const {
  struct sigaction standard {};
  standard.sa_handler = SIG_DFL;
  sigaction(received, &standard, nullptr);
  raise(received);
  std::abort();
}

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

namespace {

constexpr const char* kVariable = "QUADEDGE_PYTHON";

/// Runs a program, found on PATH where its name has no slash, with nothing to read. `quiet`: what it prints is dropped.
/// Its exit code; ExitCode::internal where it cannot be started or a signal ends it. A signal that ends this process
/// ends the other first.
int run_program(const std::vector<std::string>& words, bool quiet, const Interruption& interruption) {
  std::vector<char*> pointers;
  for (const auto& word : words) pointers.push_back(const_cast<char*>(word.c_str()));
  pointers.push_back(nullptr);
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  if (quiet) {
    posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_addopen(&files, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  }
  pid_t process = 0;
  const int problem = posix_spawnp(&process, pointers[0], &files, nullptr, pointers.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  if (problem != 0) return static_cast<int>(ExitCode::internal);
  int status = 0;
  while (waitpid(process, &status, 0) != process) {
    if (errno != EINTR) return static_cast<int>(ExitCode::internal);
    kill(process, SIGTERM);  // a signal told this process to end: the other one ends with it
  }
  if (interruption.signal() != 0) {
    note("interrupted; no page was made");
    interruption.end_process();
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : static_cast<int>(ExitCode::internal);
}

/// The interpreters to try, in their order.
std::vector<std::string> interpreters() {
  if (const char* chosen = std::getenv(kVariable); chosen != nullptr && *chosen != '\0') return {chosen};
  std::vector<std::string> names;
  std::error_code error;
  const auto beside = std::filesystem::read_symlink(kProgramFile, error).parent_path() / "venv/bin/python3";
  if (!error && std::filesystem::exists(beside, error)) names.push_back(beside.string());
  names.emplace_back("python3");
  return names;
}

}  // namespace

int make_page(const std::vector<std::string>& arguments, const Interruption& interruption) {
  setenv("PYTHONSAFEPATH", "1", 1);  // a folder named quadedge in the current folder is not the module
  std::string tried;
  for (const auto& python : interpreters()) {
    if (run_program({python, "-c", "import quadedge.report"}, true, interruption) != 0) {
      tried += (tried.empty() ? "" : ", ") + python;
      continue;
    }
    std::vector<std::string> words = {python, "-m", "quadedge.report"};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::fflush(stdout);
    return run_program(words, false, interruption);
  }
  std::fprintf(stderr,
               "quadedge: no page: %s has no module quadedge.report; install it in a virtual environment "
               "(`python3 -m venv venv && venv/bin/pip install .` in a clone of QuadEdge) and set %s to its Python\n",
               tried.c_str(), kVariable);
  return static_cast<int>(ExitCode::usage);
}

}  // namespace quadedge::cli
