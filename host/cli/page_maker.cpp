#include "cli/page_maker.hpp"

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fcntl.h>
#include <filesystem>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "cli/child_process.hpp"
#include "cli/console.hpp"
#include "quadedge/error.hpp"

namespace quadedge::cli {
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
