#include "data/program_output.hpp"

#include <cerrno>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "quadedge/error.hpp"

namespace quadedge::data {
namespace {

constexpr std::size_t kBlock = 1 << 16;  // bytes read at once: a pipe holds as many

/// Starts the program with its output and error on two pipes. \returns what posix_spawnp returns
int spawn(const std::vector<std::string>& command, int output, int messages, pid_t& process) {
  std::vector<char*> words;
  for (const std::string& word : command) words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&files, output, STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&files, messages, STDERR_FILENO);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t none, pipe;
  sigemptyset(&none);
  sigemptyset(&pipe);
  sigaddset(&pipe, SIGPIPE);  // Python ignores it
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setsigdefault(&attributes, &pipe);
  posix_spawnattr_setpgroup(&attributes, 0);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP);
  const int problem = posix_spawnp(&process, words[0], &files, &attributes, words.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&files);
  return problem;
}

}  // namespace

ProgramOutput::ProgramOutput(const std::vector<std::string>& command, const std::string& needed_for) {
  int ends[2][2] = {{-1, -1}, {-1, -1}};
  int problem = pipe2(ends[0], O_CLOEXEC) != 0 || pipe2(ends[1], O_CLOEXEC) != 0 ? errno : 0;
  if (problem == 0) problem = spawn(command, ends[0][1], ends[1][1], process_);
  for (int i = 0; i < 2; ++i) {
    pipes_[i] = ends[i][0];
    if (ends[i][1] >= 0) close(ends[i][1]);
  }
  if (problem == 0) return;
  for (const int pipe : pipes_)
    if (pipe >= 0) close(pipe);
  throw DataError(needed_for + " needs the program " + command.front() +
                  ", which cannot be started: " + (problem == ENOENT ? "it is not installed" : std::strerror(problem)));
}

ProgramOutput::~ProgramOutput() {
  kill(process_, SIGKILL);
  for (const int pipe : pipes_)
    if (pipe >= 0) close(pipe);
  while (waitpid(process_, nullptr, 0) < 0 && errno == EINTR) {
  }
}

bool ProgramOutput::wait() {
  pollfd waiting[2] = {{pipes_[0], POLLIN, 0}, {pipes_[1], POLLIN, 0}};
  if (poll(waiting, 2, -1) < 0) return errno == EINTR;
  for (int i = 0; i < 2; ++i) {
    if (pipes_[i] < 0 || waiting[i].revents == 0) continue;
    std::string& text = i == 0 ? output : messages;
    const std::size_t before = text.size();
    text.resize(before + kBlock);
    const ssize_t count = read(pipes_[i], text.data() + before, kBlock);
    text.resize(before + static_cast<std::size_t>(count > 0 ? count : 0));
    if (count > 0 || (count < 0 && errno == EINTR)) continue;
    close(pipes_[i]);
    pipes_[i] = -1;
  }
  return pipes_[0] >= 0 || pipes_[1] >= 0;
}

}  // namespace quadedge::data
