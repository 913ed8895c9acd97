#include "report/matches_csv.hpp"

#include <cstdio>

namespace quadedge::report {

std::string matches_csv(const StereoMatches& matches, bool depths) {
  std::string text = "left_x,left_y,left_direction_rad,right_x,right_y,right_direction_rad,ncc,x_m,y_m,z_m\n";
  const StereoEdges& edges = matches.edges;
  char row[240];
  for (std::size_t i = 0; i < edges.size(); ++i) {
    for (const float value : {edges.left_x[i], edges.left_y[i], edges.left_direction[i], edges.right_x[i],
                              edges.right_y[i], edges.right_direction[i]}) {
      std::snprintf(row, sizeof row, "%.6f,", static_cast<double>(value));
      text += row;
    }
    std::snprintf(row, sizeof row, "%.6f", static_cast<double>(edges.ncc[i]));
    text += row;
    if (depths && matches.points[i]) {
      const Eigen::Vector3d& point = matches.points[i]->position;
      std::snprintf(row, sizeof row, ",%.6f,%.6f,%.6f\n", point.x(), point.y(), point.z());
      text += row;
    } else {
      text += ",,,\n";
    }
  }
  return text;
}

}  // namespace quadedge::report
