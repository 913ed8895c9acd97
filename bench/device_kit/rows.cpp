#include "device_kit/rows.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace device_kit {
namespace {

struct Section {
  const char *table, *title, *about;
};

// The order of the page.
constexpr Section kSections[] = {
    {"parts", "Parts", "Every part runs in a process with a time limit, so that a failure in one hides no other."},
    {"drivers", "Drivers", "The OpenCL libraries found, each tried alone. The first one with a GPU is used."},
    {"device", "Device", ""},
    {"self_test", "Self-test",
     "The first process starts with empty caches and builds every program that the self-test needs; the second one "
     "loads what the first one kept."},
    {"programs", "Building the programs",
     "Every program that a frame needs by default, with lens distortion, mask and SIFT, built with empty caches."},
    {"tests", "Device tests that did not pass", ""},
    {"tests_total", "Device tests", ""},
    {"variants", "Kernel variants",
     "Second frame of EuRoC's flight, else of the room; default preset. Bytes are compared with those of the device's "
     "default variant, after "
     "both agreed with the plain C++ reference on a small input. Ratio: time over the default's in the same "
     "repetition. Bandwidth and arithmetic: least work of the stage over the device's measured ceilings."},
    {"ceilings", "Ceilings", "Measured by a copy and by multiply-adds."},
    {"latency", "Latency",
     "From images in host memory to the pose on the host, on a plain queue. The recorded frames are replayed forwards "
     "and backwards."},
    {"shares", "Where a frame goes",
     "Mean over the frames of a second pass with a profiling queue, which slows frames down. Driver: the device is "
     "idle although a command is enqueued. Host: the device has nothing to do."},
    {"stage_times", "Time of each stage", "Mean per frame of the same pass [ms]."},
    {"stages", "Results of each stage",
     "First pair of each sequence, compared with the results stored when the kit was built on a CPU. A stage passes "
     "where no position differs by 1e-5 px, no NCC by 0.006, no SIFT distance by 3, and no index at all."},
    {"poses", "Poses", "Twelve frames of each sequence. A pose passes where it differs by less than 1e-5 m."},
    {"differing_poses", "Poses that differ", ""},
};

struct Line {
  std::string table;
  Row row;
};

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, separator);) parts.push_back(part);
  return parts;
}

/// Lines without a line end are those of a process that was killed while it wrote.
std::vector<Line> read(const std::string& file) {
  std::ifstream stream(file);
  std::vector<Line> lines;
  for (std::string text; std::getline(stream, text) && !stream.eof();) {
    const auto parts = split(text, '\t');
    if (parts.empty()) continue;
    Line& line = lines.emplace_back();
    line.table = parts.front();
    for (std::size_t i = 1; i < parts.size(); ++i) {
      const auto equals = parts[i].find('=');
      if (equals != std::string::npos) line.row.emplace_back(parts[i].substr(0, equals), parts[i].substr(equals + 1));
    }
  }
  return lines;
}

std::string markdown_line(const std::vector<std::string>& cells) {
  std::string line = "|";
  for (const auto& cell : cells) {
    line += ' ';
    for (const char c : cell) line += c == '|' ? std::string("\\|") : std::string(1, c);
    line += " |";
  }
  return line + "\n";
}

std::string markdown_table(const std::vector<Line>& lines, const std::string& table) {
  std::vector<std::string> head;
  for (const auto& line : lines) {
    if (line.table != table) continue;
    for (const auto& [column, value] : line.row)
      if (std::find(head.begin(), head.end(), column) == head.end()) head.push_back(column);
  }
  if (head.empty()) return {};
  std::string text = markdown_line(head) + markdown_line(std::vector<std::string>(head.size(), "---"));
  for (const auto& line : lines) {
    if (line.table != table) continue;
    std::vector<std::string> cells(head.size());
    for (const auto& [column, value] : line.row)
      cells[static_cast<std::size_t>(std::find(head.begin(), head.end(), column) - head.begin())] = value;
    text += markdown_line(cells);
  }
  return text;
}

}  // namespace

void Rows::add(const std::string& table, const Row& row) const {
  std::string line = table;
  for (const auto& [column, value] : row) line += "\t" + column + "=" + value;
  // One row is one line: messages of drivers may have several, with control characters.
  std::replace_if(
      line.begin() + static_cast<std::ptrdiff_t>(table.size()), line.end(),
      [](unsigned char c) { return c < ' ' && c != '\t'; }, ' ');
  std::ofstream stream(file_, std::ios::app);
  if (!(stream << line << '\n' << std::flush)) throw std::runtime_error(file_ + ": cannot be written");
}

std::string number(double value) {
  if (!std::isfinite(value)) return "-";
  char text[32];
  const double size = std::abs(value);
  std::snprintf(text, sizeof text,
                size == 0 || size >= 100 ? "%.0f"
                : size >= 10             ? "%.1f"
                : size >= 1              ? "%.2f"
                                         : "%.3g",
                value);
  return text;
}

std::string markdown_page(const std::string& file, const Row& origin) {
  const auto lines = read(file);
  std::string text = "# QuadEdge on one OpenCL device\n\n";
  for (const auto& [what, value] : origin) text += "- " + what + ": " + value + "\n";
  for (const auto& section : kSections) {
    const std::string table = markdown_table(lines, section.table);
    if (table.empty()) continue;
    text += std::string("\n## ") + section.title + "\n\n";
    if (section.about[0] != '\0') text += std::string(section.about) + "\n\n";
    text += table;
  }
  return text;
}

}  // namespace device_kit
