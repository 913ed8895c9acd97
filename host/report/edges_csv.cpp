#include "report/edges_csv.hpp"

#include "data/text.hpp"
#include "report/csv_table.hpp"

namespace quadedge::report {
namespace {

using Columns = std::vector<CsvColumn<std::size_t>>;
constexpr int kDecimals = 6;

void add(const char* name, const std::vector<float>& values, Columns& columns) {
  columns.push_back(
      {name, [&values](std::size_t i) { return data::format_fixed(static_cast<double>(values[i]), kDecimals); }});
}

std::string table(const Columns& columns, std::size_t rows) {
  std::string text = csv_heading(columns);
  for (std::size_t i = 0; i < rows; ++i) text += csv_row(columns, i);
  return text;
}

}  // namespace

std::string edges_csv(const EdgeSet& edges) {
  Columns columns;
  add("x", edges.x, columns);
  add("y", edges.y, columns);
  add("direction_rad", edges.direction, columns);
  add("strength", edges.strength, columns);
  return table(columns, edges.size());
}

std::string matches_csv(const StereoMatches& matches, bool depths) {
  Columns columns;
  const StereoEdges& edges = matches.edges;
  add("left_x", edges.left_x, columns);
  add("left_y", edges.left_y, columns);
  add("left_direction_rad", edges.left_direction, columns);
  add("right_x", edges.right_x, columns);
  add("right_y", edges.right_y, columns);
  add("right_direction_rad", edges.right_direction, columns);
  add("ncc", edges.ncc, columns);
  const char* const names[] = {"x_m", "y_m", "z_m"};
  for (int axis = 0; axis < 3; ++axis) {
    columns.push_back({names[axis], [&matches, depths, axis](std::size_t i) {
                         const auto& point = matches.points[i];
                         return depths && point ? data::format_fixed(point->position[axis], kDecimals) : std::string();
                       }});
  }
  return table(columns, edges.size());
}

}  // namespace quadedge::report
