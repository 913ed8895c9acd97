#pragma once
/// \file rows.hpp  What device_check measures, as rows of tables in one text file. A row is written as soon as it is
/// known, so a part of the kit that crashes or runs out of time leaves the rows before.

#include <string>
#include <utility>
#include <vector>

namespace device_kit {

/// Column and value of every cell.
using Row = std::vector<std::pair<std::string, std::string>>;

/// Appends rows to a file: the table's name, then COLUMN=VALUE, separated by tabs.
class Rows {
 public:
  explicit Rows(std::string file) : file_(std::move(file)) {}
  /// Returns after the row is in the file. \throws std::runtime_error
  void add(const std::string& table, const Row& row) const;

 private:
  std::string file_;
};

/// A number with three significant digits or more, "-" for NaN.
std::string number(double value);

/// The page of all tables (Markdown) from such a file. \param origin  facts of the run for its head
std::string markdown_page(const std::string& file, const Row& origin);

}  // namespace device_kit
