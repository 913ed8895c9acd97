#include "odometry/pinhole_view.hpp"

#include "odometry/bilinear.hpp"

namespace quadedge::odometry {

float PinholeView::at(double x, double y) const {
  const auto grey = [&](int column, int row) { return recorded_.at(column, row); };
  if (table_.empty()) return bilinear(recorded_.width, recorded_.height, x, y, grey);
  return bilinear(recorded_.width, recorded_.height, static_cast<double>(bilinear(table_, table_.source_x, x, y)),
                  static_cast<double>(bilinear(table_, table_.source_y, x, y)), grey);
}

}  // namespace quadedge::odometry
