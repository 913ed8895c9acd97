#include "report/edges_csv.hpp"

#include <cstdio>

namespace quadedge::report {

std::string edges_csv(const EdgeSet& edges) {
  std::string text = "x,y,direction_rad,strength\n";
  char row[160];
  for (std::size_t i = 0; i < edges.size(); ++i) {
    std::snprintf(row, sizeof row, "%.6f,%.6f,%.6f,%.6f\n", static_cast<double>(edges.x[i]),
                  static_cast<double>(edges.y[i]), static_cast<double>(edges.direction[i]),
                  static_cast<double>(edges.strength[i]));
    text += row;
  }
  return text;
}

}  // namespace quadedge::report
