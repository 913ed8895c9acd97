/// \file processes.cpp  Signal handlers that fire once (SA_RESETHAND); tries interpreters until one imports a module.
#include "cli/processes.hpp"

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

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

constexpr const char* kVariable = "QUADEDGE_PYTHON";

/// Runs a program, found on PATH where its name has no slash, with nothing to read. `quiet`: what it prints is dropped.
/// Its exit code; ExitCode::internal where it cannot be started or a signal ends it. A signal that ends this process
/// ends the other first.
int run_program(const std::vector<std::string>& words, bool quiet) {
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

FoundPython find_python(const std::string& module) {
  setenv("PYTHONSAFEPATH", "1", 1);  // a folder named quadedge in the current folder is not the module
  FoundPython python;
  for (const auto& name : interpreters()) {
    if (run_program({name, "-c", "import " + module}, true) == 0) return {name, python.tried};
    python.tried += (python.tried.empty() ? "" : ", ") + name;
  }
  return python;
}

int make_page(const std::vector<std::string>& arguments, const Interruption& interruption) {
  const FoundPython python = find_python("quadedge.report");
  int code = static_cast<int>(ExitCode::usage);
  if (!python.found.empty()) {
    std::vector<std::string> words = {python.found, "-m", "quadedge.report"};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::fflush(stdout);
    code = run_program(words, false);
  }
  if (interruption.signal() != 0) {
    note("interrupted; no page was made");
    interruption.end_process();
  }
  if (python.found.empty())
    print_error("no page: " + python.tried +
                " has no module quadedge.report; scripts/run.sh in a clone of QuadEdge installs it beside its program; "
                "elsewhere set " +
                kVariable + " to a Python that has it");
  return code;
}

void become(const std::string& python, const std::vector<std::string>& arguments) {
  std::vector<char*> pointers = {const_cast<char*>(python.c_str())};
  for (const auto& argument : arguments) pointers.push_back(const_cast<char*>(argument.c_str()));
  pointers.push_back(nullptr);
  std::fflush(stdout);
  execvp(pointers[0], pointers.data());
  throw UsageError(python + ": cannot be started: " + std::strerror(errno));
}

}  // namespace quadedge::cli
