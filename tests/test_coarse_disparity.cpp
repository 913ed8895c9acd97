#include "device/stereo_matching.hpp"
#include "edge_images.hpp"
#include "edges/frontend.hpp"
#include "geometry/disparity_range.hpp"
#include "geometry/epipolar_geometry.hpp"
#include "matching.hpp"
#include "reference/coarse_disparity.hpp"

using namespace quadedge;
using namespace matching;

namespace {

StereoConfig range_of(double max_disparity) {
  StereoConfig config;
  config.max_disparity = max_disparity;
  return config;
}

CoarseDisparityArguments search_of(const StereoRig& rig, double max_disparity) {
  return coarse_search(rig, make_epipolar_geometry(rig, range_of(max_disparity))).value();
}

/// Two views of a wall with this disparity [px], grey(x, y) being the left one; noise of up to 3 grey levels.
template <class Grey>
std::pair<Image, Image> views(const StereoRig& rig, double disparity, const Grey& grey) {
  Random random(3);
  std::pair<Image, Image> pair{Image(rig.left.width, rig.left.height), Image(rig.right.width, rig.right.height)};
  for (auto* image : {&pair.first, &pair.second}) {
    const double shift = image == &pair.first ? 0 : disparity + rig.left.cx - rig.right.cx;
    for (int y = 0; y < image->height; ++y)
      for (int x = 0; x < image->width; ++x)
        image->set(x, y, static_cast<int>(std::lround(grey(x + shift, y) + random(-3, 3))));
  }
  return pair;
}

/// `count` uniform random numbers between low and high.
std::vector<double> random_numbers(std::uint64_t seed, int count, double low, double high) {
  Random random(seed);
  std::vector<double> numbers;
  for (int i = 0; i < count; ++i) numbers.push_back(random(low, high));
  return numbers;
}

/// Upright boards 12 px wide, each brighter or darker than the mean by up to `spread`. x from -240 to 720.
struct Boards {
  explicit Boards(double spread) : tones(random_numbers(9, 80, 150 - spread, 150 + spread)) {}
  double operator()(double x, double) const {
    const double board = std::floor(x / 12), along = x - 12 * board;
    return along < 2 ? 60 : tones.at(static_cast<std::size_t>(board + 20));
  }
  std::vector<double> tones;
};

/// Grey levels of blocks of 2 x 2 px.
Image random_blocks(int width, int height, std::uint64_t seed) {
  const auto levels = random_numbers(seed, width * height, 0, 255);
  return filled_image(width, height, [&](int x, int y) {
    return static_cast<int>(levels[static_cast<std::size_t>(y / 2 * width + x / 2)]);
  });
}

/// Of the pixels at joints of boards whose counterpart is in the image: the ratio of those that are known, and of these
/// the ratio of those that are right to within kCoarseReach.
std::pair<double, double> known_and_right(const std::vector<float>& positions, const CoarseDisparityArguments& search,
                                          double disparity) {
  int in_view = 0, known = 0, right = 0;
  for (int y = 0; y < search.height; ++y) {
    for (int x = static_cast<int>(disparity / 2) + 3; x < search.width - 3; ++x) {
      if (2 * x % 12 > 2 && 2 * x % 12 < 10) continue;
      const float position = positions[static_cast<std::size_t>(y * search.width + x)];
      ++in_view;
      if (position == kNoCoarseDisparity) continue;
      ++known;
      right += std::abs(position - static_cast<float>(disparity)) < kCoarseReach ? 1 : 0;
    }
  }
  return {static_cast<double>(known) / in_view, static_cast<double>(right) / known};
}

}  // namespace

TEST_CASE("coarse disparity: a wall of boards that differ a little is found at its own disparity") {
  StereoRig rig = flat_rig(260, 60);
  for (const double offset : {0.0, 7.0, -4.5}) {
    rig.right.cx = rig.left.cx + offset;
    for (const double disparity : {2.0, 17.0, 33.0}) {
      CAPTURE(offset, disparity);
      const auto [left, right] = views(rig, disparity, Boards(40));
      const CoarseDisparityArguments search = search_of(rig, 60);
      const auto [known, good] =
          known_and_right(reference::coarse_disparity(left.view(), right.view(), search).positions, search, disparity);
      CHECK(good > 0.97);
      CHECK(known > 0.8);
    }
  }
}

TEST_CASE("coarse disparity: breaks the tie between the boards of a wall", "[device]") {
  constexpr double kDisparity = 17;
  StereoRig rig = flat_rig(301, 101, 300);
  rig.max_disparity = 60;
  const auto [left, right] = views(rig, kDisparity, Boards(12));
  for (const std::string& name : all_devices_and_reference()) {
    Device device(name, kept_programs());
    double matched[2] = {0, 0}, correct[2] = {0, 0};
    for (const bool consults : {false, true}) {
      Config config;
      if (!consults) config.stereo.coarse_ties = 1;
      const auto frontend = frontend::make_frontend(rig, device, config);
      const auto found = frontend->process({0, left.view(), right.view()});
      matched[consults] = static_cast<double>(found->edges.size());
      for (std::size_t i = 0; i < found->edges.size(); ++i)
        correct[consults] +=
            std::abs(static_cast<double>(found->edges.left_x[i] - found->edges.right_x[i]) - kDisparity) < 1 ? 1 : 0;
    }
    CAPTURE(name, matched[0], correct[0], matched[1], correct[1]);
    CHECK(correct[0] < 0.9 * matched[0]);
    CHECK(correct[1] > 0.98 * matched[1]);
  }
}

TEST_CASE("coarse disparity: what the right image does not show stays unknown") {
  // A near board in front of a far wall hides the part of the wall to its left.
  const StereoRig rig = flat_rig(200, 60);
  const Image texture = random_blocks(400, 60, 5), near_texture = random_blocks(400, 60, 6);
  const auto view = [&](int near_shift, int far_shift) {
    return filled_image(200, 60, [&, near_shift, far_shift](int x, int y) {
      const int near_x = x + near_shift;
      return near_x >= 100 && near_x < 150 ? near_texture.view().value(near_x, y)
                                           : texture.view().value(x + far_shift + 50, y);
    });
  };
  const Image left = view(0, 0), right = view(30, 6);
  const CoarseDisparityArguments search = search_of(rig, 60);
  const auto positions = reference::coarse_disparity(left.view(), right.view(), search).positions;
  int hidden = 0, known = 0, rows = 0, right_rows = 0;
  for (int y = 5; y < search.height - 5; ++y) {
    for (int x = 40; x < 48; ++x) {  // left pixels 76 to 99 are hidden
      ++hidden;
      known += positions[static_cast<std::size_t>(y * search.width + x)] != kNoCoarseDisparity ? 1 : 0;
    }
    const auto at = [&](int x) {
      return static_cast<double>(positions[static_cast<std::size_t>(y * search.width + x)]);
    };
    ++rows;
    right_rows += std::abs(at(60) - 30) < 1 && std::abs(at(90) - 6) < 1 ? 1 : 0;
  }
  CHECK(right_rows > 0.8 * rows);
  CHECK(known < hidden / 4);
}

TEST_CASE("coarse disparity: only rectified rigs are searched") {
  const StereoConfig config = range_of(40);
  StereoRig rig = flat_rig();
  CHECK(coarse_search(rig, make_epipolar_geometry(rig, config)));
  const StereoRig crooked = crooked_rig();
  CHECK_FALSE(coarse_search(crooked, make_epipolar_geometry(crooked, config)));
  rig.right.cy += 2;  // rows differ
  CHECK_FALSE(coarse_search(rig, make_epipolar_geometry(rig, config)));
  rig = flat_rig();
  rig.right_from_left.translation().x() *= -1;  // the right camera on the left
  CHECK_FALSE(coarse_search(rig, make_epipolar_geometry(rig, config)));
  const StereoRig tiny = flat_rig(1, 1);
  CHECK_FALSE(coarse_search(tiny, make_epipolar_geometry(tiny, config)));
}

TEST_CASE("coarse disparity: every device and variant gives exactly the reference's positions", "[device][oclgrind]") {
  struct Case {
    int width, height, right_width, right_height, max_value;
    double right_cx, range;
  };
  for (const Case& of :
       {Case{113, 71, 113, 71, 255, 0, 40}, Case{87, 43, 61, 52, 255, -20, 75}, Case{64, 48, 97, 37, 4095, 31.4, 20},
        Case{38, 5, 38, 5, 255, 0, 700}, Case{3, 2, 2, 3, 255, 0, 1}}) {
    StereoRig rig = flat_rig(of.width, of.height);
    rig.right.width = of.right_width;
    rig.right.height = of.right_height;
    rig.right.cx += of.right_cx;
    const CoarseDisparityArguments search = search_of(rig, of.range);
    const Image pattern = textured_image(of.width + of.right_width, std::max(of.height, of.right_height), 4);
    const int scale = of.max_value / 255;
    const Image left = filled_image(of.width, of.height, of.max_value,
                                    [&](int x, int y) { return scale * pattern.view().value(x, y) + x % scale; }),
                right = filled_image(of.right_width, of.right_height, of.max_value,
                                     [&](int x, int y) { return scale * pattern.view().value(x + 9, y); });
    const auto expected = reference::coarse_disparity(left.view(), right.view(), search).positions;
    check_stage("coarse_disparity", [&](opencl::Context& context, const Variants& variants) -> StageArrays {
      const stages::DeviceImage on_left = upload(context, left), on_right = upload(context, right);
      stages::CoarseDisparity stage(context, variants, of.max_value);
      const std::size_t before = context.bytes();
      stage.run(on_left, on_right, search);
      CHECK(context.bytes() - before <= stages::CoarseDisparity::bytes(search));
      CHECK(2 * (context.bytes() - before) >= stages::CoarseDisparity::bytes(search));
      return {{"positions", stage.positions().read(expected.size()), expected}};
    });
  }
}
