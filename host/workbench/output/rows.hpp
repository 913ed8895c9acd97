#pragma once
/// \file rows.hpp  Text files of rows, written as the rows come, so that finished ones survive a crash: CSV (RFC 4180,
/// one line per record) by column name.

#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

namespace quadedge::report {

/// Truncates the file on opening and flushes after each append, so that a run that dies keeps all finished rows.
class AppendFile {
 public:
  /// \throws DataError with path and reason when the file cannot be opened.
  explicit AppendFile(std::string path);
  ~AppendFile();
  AppendFile(const AppendFile&) = delete;
  AppendFile& operator=(const AppendFile&) = delete;

  /// \throws DataError with path and reason (full disk) when the text cannot be written.
  void append(const std::string& text);

 private:
  [[noreturn]] void fail(const char* what) const;
  std::string path_;
  std::FILE* stream_ = nullptr;
};

/// One record: every field with the name of its column.
class CsvRow {
 public:
  void add(std::string name, std::string field);
  void add(std::string name, std::int64_t value) { add(std::move(name), std::to_string(value)); }
  std::string heading() const;  ///< the line of names
  /// The line of fields, quoted where they have commas, quotes or line breaks; these become blanks.
  std::string line() const;

 private:
  std::vector<std::string> names_, fields_;
};

}  // namespace quadedge::report
