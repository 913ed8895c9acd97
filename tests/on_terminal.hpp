#pragma once
/// \file on_terminal.hpp  Runs the quadedge program on a terminal.

#include <pty.h>
#include <sys/ioctl.h>

#include "program.hpp"

/// Output of `quadedge ARGUMENTS` on a terminal of `columns` columns; line endings are "\r\n". `environment`: arguments
/// of `env`, for example "TERM=dumb" or "-u TERM".
inline std::string run_on_terminal(const std::vector<std::string>& arguments, unsigned short columns,
                                   const std::string& environment) {
  std::string command =
      "exec " + environment_of_tests() + " env -u COLUMNS " + environment + " '" + program_path() + "'";
  for (const auto& argument : arguments) command += " '" + argument + "'";
  winsize size{};
  size.ws_col = columns;
  size.ws_row = 24;
  int terminal = -1;
  const pid_t process = forkpty(&terminal, nullptr, nullptr, &size);
  if (process == 0) {
    execl("/bin/sh", "sh", "-c", command.c_str(), static_cast<char*>(nullptr));
    _exit(127);
  }
  std::string printed;
  char buffer[4096];
  for (ssize_t count = 0; (count = read(terminal, buffer, sizeof buffer)) > 0;)
    printed.append(buffer, static_cast<std::size_t>(count));
  close(terminal);
  waitpid(process, nullptr, 0);
  return printed;
}
