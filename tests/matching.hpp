#pragma once
/// \file matching.hpp  Made-up edges, candidate lists and device runs shared by the tests of the matching stages.

#include "device/candidates.hpp"
#include "device/device_edges.hpp"
#include "device/images.hpp"
#include "device/stereo_matching.hpp"
#include "reference/candidates.hpp"
#include "stage_rows.hpp"

namespace matching {

using namespace quadedge;

/// Uniform random numbers that are the same on every platform.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed * 0x9E3779B97F4A7C15ULL + 1) {}
  double operator()(double low, double high) {
    state_ = state_ * 6364136223846793005ULL + 1442695040888963407ULL;
    return low + (high - low) * static_cast<double>(state_ >> 11) * 0x1p-53;
  }

 private:
  std::uint64_t state_;
};

/// One edge: px and radians.
struct Edge {
  double x, y, direction;
};

/// Edges in scan order of their nearest pixels, shifted by up to `slack` px: like detected ones, edges of neighbouring
/// pixels may not be in the order of x.
inline EdgeSet make_edges(std::vector<Edge> edges, int height, double slack = 0, std::uint64_t seed = 1) {
  const auto pixel = [](double v) { return std::lround(v); };
  std::stable_sort(edges.begin(), edges.end(), [&](const Edge& a, const Edge& b) {
    return std::pair(pixel(a.y), pixel(a.x)) < std::pair(pixel(b.y), pixel(b.x));
  });
  Random random(seed);
  EdgeSet set;
  set.row_first.assign(static_cast<std::size_t>(height) + 1, 0);
  for (const Edge& edge : edges) {
    const long row = std::clamp(pixel(edge.y), 0L, height - 1L);
    for (auto r = static_cast<std::size_t>(row) + 1; r < set.row_first.size(); ++r) ++set.row_first[r];
    set.x.push_back(static_cast<float>(edge.x + random(-slack, slack)));
    set.y.push_back(static_cast<float>(edge.y + random(-slack, slack)));
    set.direction.push_back(static_cast<float>(edge.direction));
    set.strength.push_back(10.0f);
    set.scale_shift.push_back(0.01f * static_cast<float>(set.size() % 50));
  }
  return set;
}

/// Arrays one behind the other.
template <class T>
std::vector<float> packed(const std::vector<const std::vector<T>*>& blocks) {
  std::vector<float> all;
  for (const auto* block : blocks) all.insert(all.end(), block->begin(), block->end());
  return all;
}

inline stages::DeviceEdges upload(opencl::Context& context, const EdgeSet& edges) {
  stages::DeviceEdges device;
  device.stride = static_cast<int>(edges.size());
  device.packed.write(context,
                      packed<float>({&edges.x, &edges.y, &edges.direction, &edges.strength, &edges.scale_shift}));
  device.row_first.write(context, edges.row_first);
  device.host_count = static_cast<int>(edges.size());
  return device;
}

inline stages::DeviceImage upload(opencl::Context& context, const Image& image) {
  stages::DeviceImage device;
  device.pixels.write(context, image.pixels);
  device.width = image.width;
  device.height = image.height;
  return device;
}

/// Candidate lists before the filters: no candidate rejected, all scores zero.
inline stages::DeviceCandidates upload(opencl::Context& context, const reference::Candidates& lists) {
  stages::DeviceCandidates device;
  device.rows = static_cast<int>(lists.first.size()) - 1;
  device.host_total = static_cast<int>(lists.target.size());
  device.reserve(context, device.host_total);
  device.first.write(context, lists.first);
  device.target.write(context, lists.target);
  device.state.fill(0, lists.target.size());
  device.ncc.fill(0, lists.target.size());
  device.sift.fill(0, lists.target.size());
  return device;
}

/// Copies the filters' decisions.
inline void upload(opencl::Context& context, const reference::CandidateScores& scores,
                   stages::DeviceCandidates& device) {
  device.ncc.write(context, scores.ncc);
  device.sift.write(context, scores.sift);
  device.state.write(context, scores.state);
}

/// Scores of candidates before any filter.
inline reference::CandidateScores fresh_scores(std::size_t candidates) {
  return {std::vector<float>(candidates, 0.9f), std::vector<float>(candidates, 10.0f),
          std::vector<std::uint8_t>(candidates, 0)};
}

/// Rectified rig of a small image.
inline StereoRig flat_rig(int width = 64, int height = 48, double focal = 60, double baseline = 0.1) {
  StereoRig rig;
  rig.left = {focal, focal, 0.5 * (width - 1), 0.5 * (height - 1), width, height};
  rig.right = rig.left;
  rig.right_from_left.translation().x() = -baseline;
  return rig;
}

/// Different cameras and image sizes, a mostly vertical baseline, rotated by a few degrees about a skew axis.
inline StereoRig crooked_rig() {
  StereoRig rig;
  rig.left = {120, 124, 70, 49, 143, 97};
  rig.right = {135, 131, 66, 60, 131, 115};
  rig.right_from_left.linear() = Eigen::AngleAxisd(0.09, Eigen::Vector3d(1, 0.4, -0.6).normalized()).toRotationMatrix();
  rig.right_from_left.translation() = Eigen::Vector3d(0.03, -0.2, 0.02);
  return rig;
}

/// A smooth texture, grey levels around 128, that can be evaluated anywhere.
inline double smooth_grey(double x, double y) {
  return 128 + 40 * std::sin(0.31 * x + 0.17 * y + 0.5) + 30 * std::sin(-0.23 * x + 0.29 * y + 1.7) +
         15 * std::cos(0.41 * x - 0.11 * y);
}

/// An image of grey(x, y) at every pixel centre, rounded to 8 bits.
inline Image image_of(int width, int height, const std::function<double(double, double)>& grey) {
  Image image(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      image.pixels[static_cast<std::size_t>(y * width + x)] =
          static_cast<std::uint8_t>(std::clamp(std::lround(grey(x, y)), 0L, 255L));
    }
  }
  return image;
}

/// Errors of photometric alignments on smooth_grey [px]. Rounding to 8 bits (0.29 grey levels in either image, 35
/// samples, slopes of about 8 grey levels per px, less in flat spots) alone causes 0.41 / (5.9 x 8) = 0.009 px.
inline void check_subpixel(const std::vector<double>& errors) {
  double sum = 0, squares = 0, largest = 0;
  std::size_t within = 0;
  for (const double error : errors) {
    sum += error;
    squares += error * error;
    largest = std::max(largest, std::abs(error));
    within += std::abs(error) < 0.02 ? 1 : 0;
  }
  const auto count = static_cast<double>(errors.size());
  CHECK(std::abs(sum) / count < 0.004);
  CHECK(std::sqrt(squares / count) < 0.015);
  CHECK(static_cast<double>(within) > 0.9 * count);
  CHECK(largest < 0.06);
}

}  // namespace matching
