#include "common/pinhole_view.hpp"

#include "common/bilinear.hpp"

namespace quadedge {

namespace {

float grey_at(const ImageView& recorded, double x, double y) {
  return bilinear(recorded.width, recorded.height, x, y, [&](int column, int row) { return recorded.at(column, row); });
}

}  // namespace

Eigen::Vector2d PinholeView::recorded_position(const Eigen::Vector2d& position) const {
  if (table_.empty()) return position;
  return {static_cast<double>(bilinear(table_, table_.source_x, position.x(), position.y())),
          static_cast<double>(bilinear(table_, table_.source_y, position.x(), position.y()))};
}

float PinholeView::at(double x, double y) const {
  const Eigen::Vector2d position = recorded_position({x, y});
  return grey_at(recorded_, position.x(), position.y());
}

PinholeView::Patch PinholeView::patch(const Eigen::Vector2d& position, const Eigen::Matrix2d& steps) const {
  if (table_.empty()) return {recorded_, position, steps};
  constexpr double kStep = 4;  // step for the derivative of the lens mapping [px]
  Eigen::Matrix2d slope;
  for (int axis = 0; axis < 2; ++axis) {
    const Eigen::Vector2d step = kStep * Eigen::Vector2d::Unit(axis);
    slope.col(axis) = (recorded_position(position + step) - recorded_position(position - step)) / (2 * kStep);
  }
  return {recorded_, recorded_position(position), slope * steps};
}

void PinholeView::Patch::sample(int half, float* values) const {
  const auto take = [&](const auto& grey) {
    for (int row = -half; row <= half; ++row) {
      for (int column = -half; column <= half; ++column) {
        const Eigen::Vector2d position = middle_ + steps_ * Eigen::Vector2d(column, row);
        *values++ = grey(position.x(), position.y());
      }
    }
  };
  const Eigen::Vector2d reach = half * steps_.cwiseAbs().rowwise().sum();
  const Eigen::Vector2d first = middle_ - reach, last = middle_ + reach;
  const bool is_inside = first.minCoeff() >= 0 && last.x() < recorded_.width - 1 && last.y() < recorded_.height - 1;
  if (!is_inside || recorded_.max_value != kMaxValue8) {
    take([&](double x, double y) { return grey_at(recorded_, x, y); });
    return;
  }
  const auto value = [&](int column, int row) {
    return static_cast<float>(recorded_.pixels[row * recorded_.stride + column]);
  };
  take([&](double x, double y) { return bilinear_inside(x, y, value); });
}

}  // namespace quadedge
