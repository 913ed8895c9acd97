#pragma once
/// \file background_program.hpp  The quadedge program as a background process that can be sent signals.

#include <csignal>
#include <fcntl.h>

#include "program.hpp"

/// The program as a background process; killed by the destructor.
class BackgroundProgram {
 public:
  BackgroundProgram(const std::vector<std::string>& arguments, const std::string& log,
                    const std::string& environment = "") {
    std::string command = "exec " + environment_of_tests() + " " + environment + " '" + program_path() + "'";
    for (const auto& argument : arguments) command += " '" + argument + "'";
    process_ = fork();
    if (process_ != 0) return;
    const int file = open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
    dup2(file, STDOUT_FILENO);
    dup2(file, STDERR_FILENO);
    execl("/bin/sh", "sh", "-c", command.c_str(), static_cast<char*>(nullptr));
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
  /// Sends a signal and waits for the end. \returns the status of waitpid
  int end_by(int signal) {
    kill(process_, signal);
    int status = 0;
    waitpid(process_, &status, 0);
    process_ = -1;
    return status;
  }
  /// Waits until the condition holds or the program has ended. \returns whether the condition holds
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
