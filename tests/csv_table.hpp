#pragma once
/// \file csv_table.hpp  Reads CSV files of results by column name.

#include "program.hpp"

/// The fields of one line, which may be quoted.
inline std::vector<std::string> csv_fields(const std::string& line) {
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

/// The fields of a column, one per row below the heading.
inline std::vector<std::string> csv_column(const std::string& file, const std::string& name) {
  const std::vector<std::string> lines = read_lines(file);
  const auto names = csv_fields(lines.at(0));
  const auto at = std::find(names.begin(), names.end(), name) - names.begin();
  std::vector<std::string> column;
  for (auto line = lines.begin() + 1; line != lines.end(); ++line)
    column.push_back(csv_fields(*line).at(static_cast<std::size_t>(at)));
  return column;
}

/// The same as numbers, NaN for empty fields.
inline std::vector<double> csv_numbers(const std::string& file, const std::string& name) {
  std::vector<double> numbers;
  for (const auto& field : csv_column(file, name)) numbers.push_back(field.empty() ? std::nan("") : std::stod(field));
  return numbers;
}
