/// \file rows.cpp  Quotes fields where needed, line breaks become spaces; flushes after every append.
#include "output/rows.hpp"

#include <cerrno>
#include <cstring>

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

}  // namespace quadedge::report
