#pragma once
/// \file csv_table.hpp  CSV files (RFC 4180, one line per record) by column name: written from one list of columns, and
/// read back.

#include <functional>
#include <string>
#include <vector>

namespace quadedge::report {

/// One column: its name, and its field in the row of an item.
template <class Item>
struct CsvColumn {
  std::string name;
  std::function<std::string(const Item&)> field;
};

/// A field, quoted where it has commas, quotes or line breaks; these become blanks.
std::string csv_field(const std::string& text);

/// A record, with a line end.
std::string csv_line(const std::vector<std::string>& fields);

/// The fields of one record.
std::vector<std::string> csv_fields(const std::string& line);

template <class Item>
std::string csv_heading(const std::vector<CsvColumn<Item>>& columns) {
  std::vector<std::string> names;
  for (const auto& column : columns) names.push_back(column.name);
  return csv_line(names);
}

template <class Item>
std::string csv_row(const std::vector<CsvColumn<Item>>& columns, const Item& item) {
  std::vector<std::string> fields;
  for (const auto& column : columns) fields.push_back(column.field(item));
  return csv_line(fields);
}

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
