#pragma once
/// \file batch_folders.hpp  Small batches for tests: a folder of rendered sequences, and a batch that can be killed.

#include <chrono>
#include <csignal>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>
#include <vector>

#include "program.hpp"

/// Rendered sequences a/first, a/second and broken (without calibration.txt), made once per process. Do not change
/// them.
inline const std::string& batch_root() {
  static const TemporaryFolder folder;
  static const std::string root = [] {
    for (const auto& [name, seed] : {std::pair<std::string, std::string>{"a/first", "1"}, {"a/second", "2"}}) {
      const std::string place = folder / ("root/" + name);
      const auto result =
          run_program({"synth", place, "--frames", "4", "--size", "240x150", "--seed", seed, "--quiet"});
      if (result.code != 0) throw std::runtime_error("synth failed: " + result.err);
    }
    std::filesystem::copy(folder / "root/a/first", folder / "root/broken", std::filesystem::copy_options::recursive);
    std::filesystem::remove(folder / "root/broken/calibration.txt");
    return folder / "root";
  }();
  return root;
}

/// The program running on its own; killed with its object.
class BackgroundProgram {
 public:
  BackgroundProgram(const std::vector<std::string>& arguments, const std::string& log) {
    std::vector<char*> pointers = {const_cast<char*>(QUADEDGE_PROGRAM)};
    for (const auto& argument : arguments) pointers.push_back(const_cast<char*>(argument.c_str()));
    pointers.push_back(nullptr);
    process_ = fork();
    if (process_ != 0) return;
    unsetenv("QUADEDGE_DEVICE");
    const int file = open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
    dup2(file, STDOUT_FILENO);
    dup2(file, STDERR_FILENO);
    execv(QUADEDGE_PROGRAM, pointers.data());
    _exit(127);
  }
  ~BackgroundProgram() {
    if (process_ > 0) end_by(SIGKILL);
  }
  BackgroundProgram(const BackgroundProgram&) = delete;
  BackgroundProgram& operator=(const BackgroundProgram&) = delete;

  pid_t process() const { return process_; }
  bool running() const {
    siginfo_t ended{};
    return waitid(P_PID, static_cast<id_t>(process_), &ended, WEXITED | WNOHANG | WNOWAIT) == 0 && ended.si_pid == 0;
  }
  /// Sends a signal and waits; what waitpid reports.
  int end_by(int signal) {
    kill(process_, signal);
    int status = 0;
    waitpid(process_, &status, 0);
    process_ = -1;
    return status;
  }
  /// Waits until something is so or the program has ended. Was it so?
  bool wait_until(const std::function<bool()>& condition) const {
    while (running()) {
      if (condition()) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return condition();
  }

 private:
  pid_t process_ = -1;
};
