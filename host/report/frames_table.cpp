#include "report/frames_table.hpp"

#include <algorithm>
#include <limits>

#include "data/text.hpp"
#include "report/run_record.hpp"

namespace quadedge::report {
namespace {

constexpr const char* kExpected = "a frames.csv of `quadedge run`";

/// Position of a column. \throws DataError when there is none.
std::size_t column(const std::vector<std::string>& names, const std::string& name, const std::string& file) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) data::fail(file, "no column " + name, kExpected);
  return static_cast<std::size_t>(found - names.begin());
}

double number(const std::string& field, const std::string& file, int line) {
  if (field.empty()) return std::numeric_limits<double>::quiet_NaN();
  return data::parse_number(field, file, line, "a number");
}

}  // namespace

std::vector<std::string> csv_fields(const std::string& line) {
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (quoted && c == '"' && i + 1 < line.size() && line[i + 1] == '"')
      fields.back() += line[++i];
    else if (c == '"')
      quoted = !quoted;
    else if (c == ',' && !quoted)
      fields.emplace_back();
    else
      fields.back() += c;
  }
  return fields;
}

FramesTable read_frames_table(const std::string& file) {
  const auto lines = data::data_lines(file);
  if (lines.empty()) data::fail(file, "an empty file", kExpected);
  const auto names = csv_fields(lines[0].text);
  const std::size_t stamp = column(names, "stamp_s", file), status = column(names, "status", file);
  const std::size_t key_rig = column(names, "new_key_rig", file), latency = column(names, "latency_ms", file);
  std::vector<std::size_t> counts, stages;
  FramesTable table;
  for (const auto& [name, unused] : named_counts({})) {
    (void)unused;
    counts.push_back(column(names, name, file));
    table.counts.emplace_back(name, std::vector<double>());
  }
  const std::string suffix = "_ms";
  for (std::size_t i = latency + 1; i < names.size(); ++i) {
    if (names[i].size() <= suffix.size() || names[i].substr(names[i].size() - suffix.size()) != suffix) continue;
    stages.push_back(i);
    table.stages_ms.emplace_back(names[i].substr(0, names[i].size() - suffix.size()), std::vector<double>());
  }
  for (std::size_t row = 1; row < lines.size(); ++row) {
    const auto fields = csv_fields(lines[row].text);
    const int line = lines[row].number;
    if (fields.size() != names.size()) {
      data::fail(file, line, std::to_string(fields.size()) + " fields",
                 std::to_string(names.size()) + " as in the heading");
    }
    table.stamp_s.push_back(number(fields[stamp], file, line));
    table.status.push_back(fields[status]);
    table.new_key_rig.push_back(fields[key_rig] == "1");
    table.latency_ms.push_back(number(fields[latency], file, line));
    for (std::size_t i = 0; i < counts.size(); ++i)
      table.counts[i].second.push_back(number(fields[counts[i]], file, line));
    for (std::size_t i = 0; i < stages.size(); ++i)
      table.stages_ms[i].second.push_back(number(fields[stages[i]], file, line));
  }
  return table;
}

}  // namespace quadedge::report
