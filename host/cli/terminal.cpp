#include "cli/terminal.hpp"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <sys/ioctl.h>
#include <unistd.h>

namespace quadedge::cli {
namespace {

constexpr std::size_t kNarrowest = 40;

/// Where the description of a line of help begins: after two blanks or more behind its first words.
std::size_t description_column(const std::string& line) {
  const std::size_t first = line.find_first_not_of(' ');
  const std::size_t gap = line.find("  ", first);
  const std::size_t description = gap == std::string::npos ? gap : line.find_first_not_of(' ', gap);
  return description == std::string::npos ? first : description;
}

std::string wrapped_line(std::string line, std::size_t width) {
  std::size_t column = description_column(line);
  if (column > width / 2) column = line.find_first_not_of(' ') + 2;
  std::string text;
  while (line.size() > width) {
    std::size_t end = line.rfind(' ', width);
    if (end == std::string::npos || end <= column) end = line.rfind('|', width - 1) + 1;  // a list of words
    if (end == 0 || end <= column) end = line.find(' ', width);
    const std::size_t next = end == std::string::npos ? end : line.find_first_not_of(' ', end);
    if (next == std::string::npos) break;
    text += line.substr(0, line.find_last_not_of(' ', end - 1) + 1) + "\n";
    line = std::string(column, ' ') + line.substr(next);
  }
  return text + line;
}

}  // namespace

bool has_escape_codes(int stream) {
  const char* kind = std::getenv("TERM");
  return isatty(stream) != 0 && kind != nullptr && *kind != '\0' && std::strcmp(kind, "dumb") != 0;
}

int terminal_width(int stream) {
  if (const char* columns = std::getenv("COLUMNS"); columns != nullptr) {
    int width = 0;
    const char* const end = columns + std::strlen(columns);
    const auto [rest, error] = std::from_chars(columns, end, width);
    if (error == std::errc() && rest == end && width > 0) return width;
  }
  winsize window{};
  return ioctl(stream, TIOCGWINSZ, &window) == 0 ? window.ws_col : 0;
}

std::string wrapped(const std::string& text, int width) {
  if (width <= 0) return text;
  std::istringstream lines(text);
  std::string result;
  for (std::string line; std::getline(lines, line);) {
    const bool is_example = line.rfind("  quadedge ", 0) == 0;
    result += (is_example ? line : wrapped_line(line, std::max(kNarrowest, static_cast<std::size_t>(width)))) + "\n";
  }
  return result;
}

}  // namespace quadedge::cli
