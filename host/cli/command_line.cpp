#include "cli/command_line.hpp"

#include <fstream>

namespace quadedge::cli {

std::string command_line() {
  std::ifstream stream("/proc/self/cmdline", std::ios::binary);
  std::string argument, line = "quadedge";
  std::getline(stream, argument, '\0');  // the program
  while (std::getline(stream, argument, '\0')) line += " " + argument;
  return line;
}

}  // namespace quadedge::cli
