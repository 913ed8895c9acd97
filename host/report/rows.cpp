#include "report/rows.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "common/numeric.hpp"
#include "data/text.hpp"
#include "quadedge/error.hpp"

namespace quadedge::report {
namespace {

std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted += '"';
    quoted += c == '\n' || c == '\r' ? ' ' : c;
  }
  return quoted + "\"";
}

std::string csv_line(const std::vector<std::string>& fields) {
  std::string line;
  for (std::size_t i = 0; i < fields.size(); ++i) line += (i == 0 ? "" : ",") + csv_field(fields[i]);
  return line + "\n";
}

}  // namespace

AppendFile::AppendFile(std::string path) : path_(std::move(path)), stream_(std::fopen(path_.c_str(), "wb")) {
  if (stream_ == nullptr) fail("opened for writing");
}

AppendFile::~AppendFile() {
  if (stream_ != nullptr) std::fclose(stream_);
}

void AppendFile::append(const std::string& text) {
  if (std::fwrite(text.data(), 1, text.size(), stream_) != text.size() || std::fflush(stream_) != 0) fail("written");
}

void AppendFile::fail(const char* what) const {
  throw DataError(path_ + ": cannot be " + what + ": " + std::strerror(errno));
}

void CsvRow::add(std::string name, std::string field) {
  names_.push_back(std::move(name));
  fields_.push_back(std::move(field));
}

std::string CsvRow::heading() const { return csv_line(names_); }
std::string CsvRow::line() const { return csv_line(fields_); }

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

CsvTable::CsvTable(std::string file, std::string expected) : file_(std::move(file)), expected_(std::move(expected)) {
  const auto lines = data::data_lines(file_);
  if (lines.empty()) data::fail(file_, "an empty file", expected_);
  names_ = csv_fields(lines.front().text);
  for (std::size_t i = 1; i < lines.size(); ++i) {
    rows_.push_back({lines[i].number, csv_fields(lines[i].text)});
    if (rows_.back().fields.size() != names_.size()) {
      data::fail(file_, lines[i].number, data::counted(rows_.back().fields.size(), "field"),
                 std::to_string(names_.size()) + " as in the heading");
    }
  }
}

std::size_t CsvTable::position(const std::string& column) const {
  const auto found = std::find(names_.begin(), names_.end(), column);
  if (found == names_.end()) data::fail(file_, "no column " + column, expected_);
  return static_cast<std::size_t>(found - names_.begin());
}

std::vector<std::string> CsvTable::texts(const std::string& column) const {
  const std::size_t at = position(column);
  std::vector<std::string> texts;
  for (const auto& row : rows_) texts.push_back(row.fields[at]);
  return texts;
}

std::vector<double> CsvTable::numbers(const std::string& column) const {
  const std::size_t at = position(column);
  std::vector<double> numbers;
  for (const auto& row : rows_) {
    const std::string& field = row.fields[at];
    numbers.push_back(field.empty() ? kNan : data::parse_number(field, file_, row.line, "a number in " + column));
  }
  return numbers;
}

}  // namespace quadedge::report
