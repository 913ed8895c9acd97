#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "data/text.hpp"
#include "dataset_files.hpp"

using namespace quadedge;
using dataset_files::real_data;

namespace {

double degrees(const Eigen::Matrix3d& rotation) { return Eigen::AngleAxisd(rotation).angle() * 180 / kPi; }

cv::Mat grey(const std::string& file, const UndistortionTable& table) {
  const Image image = read_grey_image(file);
  cv::Mat pixels = cv::Mat(image.height, image.width, CV_8U, const_cast<std::uint8_t*>(image.pixels.data())).clone();
  if (table.empty()) return pixels;
  const cv::Mat x(table.height, table.width, CV_32F, const_cast<float*>(table.source_x.values().data()));
  const cv::Mat y(table.height, table.width, CV_32F, const_cast<float*>(table.source_y.values().data()));
  cv::remap(pixels, pixels, x, y, cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  return pixels;
}

/// Corners found in a band of rows of the right image by plain correlation, then triangulated with the rig: how many
/// were found, and the fraction of these that lie in front of both cameras and within 1.5 px of their reprojection.
struct RigTest {
  double ratio = 0;
  int tracked = 0;
};
/// Repeated texture occasionally misleads the plain search; a rig with a wrong direction leaves almost nothing.
constexpr double kInlierRatio = 0.7;
RigTest test_rig(const Dataset& set, std::size_t frame) {
  const cv::Mat left = grey(set.frames[frame].left, set.rig.left_undistortion);
  const cv::Mat right = grey(set.frames[frame].right, set.rig.right_undistortion);
  std::vector<cv::Point2f> from;
  cv::goodFeaturesToTrack(left, from, 400, 0.01, 8);
  RigTest result;
  int good = 0;
  const Eigen::Isometry3d& right_from_left = set.rig.right_from_left;
  for (const auto& corner : from) {
    constexpr int kHalf = 7, kBand = 24;
    const cv::Rect patch(static_cast<int>(corner.x) - kHalf, static_cast<int>(corner.y) - kHalf, 2 * kHalf + 1,
                         2 * kHalf + 1);
    if ((patch & cv::Rect(0, 0, left.cols, left.rows)) != patch) continue;
    const cv::Rect band =
        cv::Rect(0, patch.y - kBand, right.cols, patch.height + 2 * kBand) & cv::Rect(0, 0, right.cols, right.rows);
    cv::Mat score;
    cv::matchTemplate(right(band), left(patch), score, cv::TM_CCOEFF_NORMED);
    double best = 0;
    cv::Point place;
    cv::minMaxLoc(score, nullptr, &best, nullptr, &place);
    if (best < 0.95) continue;
    ++result.tracked;
    const Eigen::Vector3d a = set.rig.left.ray({patch.x + kHalf, patch.y + kHalf});
    const Eigen::Vector3d b = set.rig.right.ray({band.x + place.x + kHalf, band.y + place.y + kHalf});
    // Depths of both rays where they come closest: [R a, -b] (z1, z2)^T = -t.
    Eigen::Matrix<double, 3, 2> rays;
    rays << right_from_left.linear() * a, -b;
    const Eigen::Vector2d depths = rays.colPivHouseholderQr().solve(-right_from_left.translation());
    if (depths.minCoeff() <= 0) continue;
    const Eigen::Vector2d seen = set.rig.right.project(right_from_left * (depths[0] * a));
    const Eigen::Vector2d found(band.x + place.x + kHalf, band.y + place.y + kHalf);
    if ((seen - found).norm() < 1.5) ++good;
  }
  result.ratio = result.tracked ? static_cast<double>(good) / result.tracked : 0;
  return result;
}

}  // namespace

TEST_CASE("real data: KITTI has the published number of frames, rig and step lengths", "[real]") {
  const std::string root = real_data("kitti_odometry");
  if (root.empty()) return;
  DatasetOptions options;
  options.sequence = "06";
  const Dataset set = open_dataset(root, options);
  CHECK(set.frames.size() == 36);
  CHECK(set.rig.left.width == 1226);
  CHECK(set.rig.left.fx == Approx(707.0912));
  CHECK(set.rig.baseline() == Approx(0.5372).epsilon(1e-3));
  CHECK(set.rig.disparity_range() > 100);
  REQUIRE(set.truth.size() == 36);
  const double length =
      (set.truth[35].world_from_left.translation() - set.truth[0].world_from_left.translation()).norm() / 35;
  CHECK(length == Approx(1.19).margin(0.01));
  CHECK(check_dataset(root, options).errors.empty());
  options.sequence = "01";
  CHECK(open_dataset(root, options).frames.size() == 25);
  CHECK_THROWS_AS(open_dataset(root), UsageError);
  const RigTest rig = test_rig(set, 12);
  CHECK(rig.tracked > 100);
  CHECK(rig.ratio > kInlierRatio);
}

TEST_CASE("real data: EuRoC at rest does not move, and its undistorted images fit the rig", "[real]") {
  for (const auto& [name, frames] :
       {std::pair<const char*, std::size_t>{"euroc_v1_01_easy_at_rest", 40}, {"euroc_v1_01_easy_keyframes", 86}}) {
    const std::string root = real_data(name);
    if (root.empty()) return;
    INFO(name);
    const Dataset set = open_dataset(root);
    CHECK(set.frames.size() == frames);
    CHECK(set.name == name);
    CHECK(set.rig.baseline() == Approx(0.110).margin(0.001));
    CHECK(set.rig.left.width == 752);
    CHECK_FALSE(set.rig.right_undistortion.empty());
    REQUIRE(set.truth.size() == frames);
    if (frames == 40) {
      for (std::size_t i = 1; i < frames; ++i) {
        const Eigen::Isometry3d step = set.truth[i - 1].world_from_left.inverse() * set.truth[i].world_from_left;
        CHECK(step.translation().norm() < 0.001);
        CHECK(degrees(step.linear()) < 0.12);
      }
      CHECK(check_dataset(root).errors.empty());
    }
    const RigTest rig = test_rig(set, 5);
    CHECK(rig.tracked > 50);
    CHECK(rig.ratio > kInlierRatio);
  }
}

TEST_CASE("real data: every still pair opens, and its rig puts matches in front of the cameras", "[real][long]") {
  const std::pair<const char*, const char*> pairs[] = {
      {"eth3d_two_view/two_view_training/terrace_2s", "eth3d-two-view"},
      {"eth3d_two_view/two_view_training/delivery_area_1l", "eth3d-two-view"},
      {"eth3d_two_view/two_view_training/electro_1s", "eth3d-two-view"},
      {"middlebury_2014/Motorcycle-perfect-quarter", "middlebury-2014"},
      {"middlebury_2005/Art", "middlebury-2005"},
      {"middlebury_2005/Dolls", "middlebury-2005"},
      {"middlebury_2003/teddy", "middlebury-2003"},
      {"middlebury_2006/Aloe", "middlebury-2005"},
      {"karlsruhe_quad", "viso2-quad"}};
  for (const auto& [folder, format] : pairs) {
    const std::string root = real_data(folder);
    if (root.empty()) return;
    INFO(folder);
    const Dataset set = open_dataset(root);
    CHECK(set.format == format);
    CHECK(check_dataset(root).errors.empty());
    const RigTest rig = test_rig(set, 0);
    CHECK(rig.tracked > 50);
    CHECK(rig.ratio > kInlierRatio);
  }
}

TEST_CASE("real data: ground-truth disparities are positive and within the reader's range", "[real]") {
  for (const char* folder :
       {"eth3d_two_view/two_view_training/terrace_2s", "middlebury_2014/Motorcycle-perfect-quarter",
        "middlebury_2005/Art", "middlebury_2005/Reindeer", "middlebury_2003/teddy", "middlebury_2006/Aloe"}) {
    const std::string root = real_data(folder);
    if (root.empty()) return;
    INFO(folder);
    const Dataset set = open_dataset(root);
    REQUIRE_FALSE(set.disparity_truth.empty());
    std::vector<double> disparities;
    if (set.disparity_truth.find(".pfm") != std::string::npos) {
      std::vector<float> values(static_cast<std::size_t>(set.rig.left.width * set.rig.left.height));
      const std::string bytes = data::read_bytes(set.disparity_truth);  // which end with little-endian floats
      std::memcpy(values.data(), bytes.data() + bytes.size() - values.size() * sizeof(float),
                  values.size() * sizeof(float));
      for (const float value : values) {
        if (std::isfinite(value)) disparities.push_back(value * set.disparity_truth_scale);
      }
    } else {
      for (const auto value : read_grey_image(set.disparity_truth).pixels) {
        if (value > 0) disparities.push_back(value * set.disparity_truth_scale);
      }
    }
    REQUIRE(disparities.size() > 10'000);
    const auto [smallest, largest] = std::minmax_element(disparities.begin(), disparities.end());
    const double offset = set.rig.right.cx - set.rig.left.cx;
    UNSCOPED_INFO("disparities " << *smallest << " to " << *largest << ", range " << set.rig.disparity_range()
                                 << ", offset " << offset);
    CHECK(*smallest + offset > 0);
    CHECK(*largest + offset <= set.rig.disparity_range());
    CHECK(*largest + offset > 0.2 * set.rig.disparity_range());  // nor is the range far too wide
  }
}
