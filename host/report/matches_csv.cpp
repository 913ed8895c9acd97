#include "report/matches_csv.hpp"

#include "report/csv_table.hpp"
#include "report/number_text.hpp"

namespace quadedge::report {

std::string matches_csv(const StereoMatches& matches, bool depths) {
  std::vector<CsvColumn<std::size_t>> columns;
  const auto add = [&](const char* name, const std::vector<float>& values) {
    columns.push_back({name, [&values](std::size_t i) { return six_decimals(static_cast<double>(values[i])); }});
  };
  const StereoEdges& edges = matches.edges;
  add("left_x", edges.left_x);
  add("left_y", edges.left_y);
  add("left_direction_rad", edges.left_direction);
  add("right_x", edges.right_x);
  add("right_y", edges.right_y);
  add("right_direction_rad", edges.right_direction);
  add("ncc", edges.ncc);
  const char* const names[] = {"x_m", "y_m", "z_m"};
  for (int axis = 0; axis < 3; ++axis) {
    columns.push_back({names[axis], [&matches, depths, axis](std::size_t i) {
                         const auto& point = matches.points[i];
                         return depths && point ? six_decimals(point->position[axis]) : std::string();
                       }});
  }
  std::string text = csv_heading(columns);
  for (std::size_t i = 0; i < edges.size(); ++i) text += csv_row(columns, i);
  return text;
}

}  // namespace quadedge::report
