#include "report/edges_csv.hpp"

#include "report/csv_table.hpp"
#include "report/number_text.hpp"

namespace quadedge::report {

std::string edges_csv(const EdgeSet& edges) {
  std::vector<CsvColumn<std::size_t>> columns;
  const auto add = [&](const char* name, const std::vector<float>& values) {
    columns.push_back({name, [&values](std::size_t i) { return six_decimals(static_cast<double>(values[i])); }});
  };
  add("x", edges.x);
  add("y", edges.y);
  add("direction_rad", edges.direction);
  add("strength", edges.strength);
  std::string text = csv_heading(columns);
  for (std::size_t i = 0; i < edges.size(); ++i) text += csv_row(columns, i);
  return text;
}

}  // namespace quadedge::report
