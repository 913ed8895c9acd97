#pragma once
/// \file rows.hpp  Text files of rows: written as the rows come, so that finished ones survive a crash, and CSV (RFC
/// 4180, one line per record) by column name.

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

/// The fields of one line.
std::vector<std::string> csv_fields(const std::string& line);

/// A CSV file with a heading.
class CsvTable {
 public:
  /// \param expected  what the file should be, for messages: "a frames.csv of `quadedge run`"
  /// \throws DataError for a missing or empty file, and for a row whose length differs from the heading's.
  CsvTable(std::string file, std::string expected);

  std::size_t rows() const { return rows_.size(); }
  /// One field per row. \throws DataError for a column that does not exist.
  std::vector<std::string> texts(const std::string& column) const;
  /// The same as numbers, NaN for empty fields. \throws DataError also for a field that is not a number.
  std::vector<double> numbers(const std::string& column) const;

 private:
  struct Row {
    int line;
    std::vector<std::string> fields;
  };
  std::size_t position(const std::string& column) const;

  std::string file_, expected_;
  std::vector<std::string> names_;
  std::vector<Row> rows_;
};

}  // namespace quadedge::report
