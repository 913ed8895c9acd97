#include "device/images.hpp"
#include "edge_images.hpp"
#include "geometry/undistortion.hpp"
#include "stage_rows.hpp"

using namespace quadedge;

namespace {

Image pattern(int width, int height, int max_value = kMaxValue8) {
  return filled_image(width, height, max_value, [=](int x, int y) {
    return (x * 37 + y * 101 + x * y * 5) * (max_value / kMaxValue8) % (max_value + 1);
  });
}

/// A table that shifts by (dx, dy) and extends beyond the border.
UndistortionTable shift_table(int width, int height, float dx, float dy) {
  UndistortionTable table{width, height, {}, {}};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      table.source_x.change().push_back(static_cast<float>(x) + dx);
      table.source_y.change().push_back(static_cast<float>(y) + dy);
    }
  }
  return table;
}

}  // namespace

TEST_CASE("undistortion: every device and variant equals the reference exactly", "[device][oclgrind]") {
  check_stage("undistortion", [](opencl::Context& context, const Variants& variants) {
    StageArrays arrays;
    for (const auto& [width, height] : {std::pair{1, 1}, {3, 5}, {17, 31}, {64, 48}}) {
      for (const int max_value : {255, 4095, 65535}) {
        const Image image = pattern(width + 2, height + 3, max_value);
        for (const auto& [dx, dy] : {std::pair{0.37f, 1.61f}, {-3.25f, 4.8f}}) {  // the second leaves the image
          const auto table = shift_table(width, height, dx, dy);
          stages::Undistortion stage(context, table, width, height, variants, max_value);
          opencl::Buffer<cl_uchar> result;
          stage.run(image.view(), result);
          const Image expected = undistort(image.view(), table);
          arrays.emplace_back(std::to_string(width) + " columns, values to " + std::to_string(max_value),
                              result.read(expected.pixels.size()), expected.pixels);
        }
      }
    }
    return arrays;
  });
}

TEST_CASE("undistortion: a reduced pixel is the mean of four positions half a pixel apart, also at the border") {
  const Image image = pattern(40, 40);
  const UndistortionTable table = shift_table(40, 40, 1.3f, -0.6f), none;
  const PinholeCamera camera{40, 40, 20, 20, 40, 40};
  constexpr int kBlock = PinholeView::kBlock;
  Eigen::Matrix2d steps;
  steps << 2, 0.3, -0.2, 2.2;
  for (const bool at_border : {false, true}) {
    const PinholeView view(image.view(), at_border ? none : table, camera);
    const Eigen::Vector2d middle = at_border ? Eigen::Vector2d(3, 36) : Eigen::Vector2d(19.4, 20.7);
    float values[kBlock * kBlock];
    view.reduced(middle, steps, values);
    for (const auto& [column, row] : {std::pair{0, 0}, {7, 0}, {3, 5}, {7, 7}}) {
      float sum = 0;
      for (const double u : {-0.25, 0.25}) {
        for (const double v : {-0.25, 0.25}) {
          const Eigen::Vector2d at = middle + steps * Eigen::Vector2d(column - 3.5 + u, row - 3.5 + v);
          sum += view.at(at.x(), at.y());
        }
      }
      CHECK(values[row * kBlock + column] == Approx(sum / 4).margin(0.05));
    }
  }
}
