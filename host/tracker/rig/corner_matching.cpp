/// \file corner_matching.cpp  Coarse search in views of infinity, there and back; subpixel alignment at equal contrast.
#include "rig/corner_matching.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <tbb/parallel_for.h>

#include "rig/patch_search.hpp"
#include "rig/rig_constants.hpp"

namespace quadedge::rig {
namespace {

constexpr int kAlignedHalf = 5, kAlignedSide = 2 * kAlignedHalf + 1,
              kWithBorder = kAlignedSide + 2;  // patches of 11 x 11 samples

/// Samples of a patch, from -kAlignedHalf - 1 to kAlignedHalf + 1 in both directions; array columns are image columns.
using Samples = Eigen::Array<float, kWithBorder, kWithBorder, Eigen::RowMajor>;

Samples cut(const PinholeView& view, const Eigen::Vector2d& centre, const Eigen::Matrix2d& steps) {
  Samples samples;
  view.patch(centre, steps).sample(-kAlignedHalf - 1, kAlignedHalf + 1, samples.data());
  return samples;
}

/// The samples without the border, shifted by `column` and `row`.
auto inner(const Samples& samples, int column = 0, int row = 0) {
  return samples.block<kAlignedSide, kAlignedSide>(1 + row, 1 + column);
}

/// Mean of the inner samples, and norm of their deviations from it.
struct Level {
  float mean = 0, norm = 0;
};

Level level_of(const Samples& samples) {
  const float mean = inner(samples).mean();
  return {mean, (inner(samples) - mean).matrix().norm()};
}

/// Whether a patch holds saturated pixels: their borders are where the light exceeds the range, which depends on the
/// exposure and differs between the cameras.
bool is_saturated(const Samples& samples) { return samples.maxCoeff() >= kSaturated; }

/// Normal equations of the shift that aligns one patch with another at equal contrast.
struct Alignment {
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  Eigen::Vector2d right_side = Eigen::Vector2d::Zero();
  double cost = 0;  ///< squared difference of the patches normalised to norm 1: 2 (1 - correlation)
};

Alignment compare(const Samples& wanted, const Level& wanted_level, const Samples& found, const Level& found_level) {
  using Inner = Eigen::Array<float, kAlignedSide, kAlignedSide, Eigen::RowMajor>;
  const float half = 0.5F / found_level.norm;
  const Inner difference = (inner(wanted) - wanted_level.mean) * (1 / wanted_level.norm) -
                           (inner(found) - found_level.mean) * (1 / found_level.norm),
              slope_x = (inner(found, 1, 0) - inner(found, -1, 0)) * half,
              slope_y = (inner(found, 0, 1) - inner(found, 0, -1)) * half;
  const auto sum = [](const auto& values) { return static_cast<double>(values.sum()); };
  Alignment sums;
  const double xy = sum(slope_x * slope_y);
  sums.normal << sum(slope_x.square()), xy, xy, sum(slope_y.square());
  sums.right_side << sum(slope_x * difference), sum(slope_y * difference);
  sums.cost = sum(difference.square());
  return sums;
}

/// Light of the pixels of a plane that are not black, as those outside the image are.
struct Light {
  double mean = 0, saturated = 0;
};

Light light_of(const GreyPlane& plane) {
  double sum = 0, saturated = 0, count = 0;
  for (std::size_t i = 0; i < plane.mean.size(); ++i) {
    if (!(plane.grey[i] > 0)) continue;
    count += 1;
    sum += static_cast<double>(plane.grey[i]);
    saturated += plane.grey[i] >= kSaturated ? 1 : 0;
  }
  return {sum / std::max(1.0, count), saturated / std::max(1.0, count)};
}

/// Result of searching for one corner.
struct SearchedCorner {
  bool has_line = false, is_negative = false, is_saturated = false;
  std::optional<CornerMatch> found;
};

}  // namespace

CornerMatcher::CornerMatcher(const StereoRig& rig)
    : rig_(rig),
      h_(rig.right.matrix() * rig.right_from_left.linear() * rig.left.matrix().inverse()),
      t_(rig.right.matrix() * rig.right_from_left.translation()) {}

std::optional<Eigen::Vector2d> CornerMatcher::at_infinity(const Eigen::Vector2d& left) const {
  const Eigen::Vector3d seen = h_ * left.homogeneous();
  if (!(seen.z() > 1e-6)) return std::nullopt;
  return seen.hnormalized();
}

std::optional<CornerMatcher::Line> CornerMatcher::line(const Eigen::Vector2d& left) const {
  const auto infinity = at_infinity(left);
  if (!infinity) return std::nullopt;
  const Eigen::Vector2d towards = t_.head<2>() - *infinity * t_.z();
  if (!(towards.norm() > 0)) return std::nullopt;
  const Eigen::Vector2d direction = towards.normalized();
  return Line{*infinity, direction, {direction.y(), -direction.x()}, h_.row(2).dot(left.homogeneous())};
}

std::optional<CornerMatch> CornerMatcher::refine(const PinholeView& left, const PinholeView& right,
                                                 const Eigen::Vector2d& corner_at, Eigen::Vector2d position) const {
  const auto epipolar = line(corner_at);
  const auto here = at_infinity(corner_at), beside = at_infinity(corner_at + Eigen::Vector2d::UnitX()),
             below = at_infinity(corner_at + Eigen::Vector2d::UnitY());
  if (!epipolar || !here || !beside || !below || !left.holds(corner_at, kAlignedHalf + 1)) return std::nullopt;
  Eigen::Matrix2d steps;  // axes of the left patch in the right image
  steps << *beside - *here, *below - *here;
  const Samples wanted = cut(left, corner_at, Eigen::Matrix2d::Identity());
  if (is_saturated(wanted)) return std::nullopt;
  const Level wanted_level = level_of(wanted);
  const double reach = (kAlignedHalf + 1) * steps.cwiseAbs().rowwise().sum().maxCoeff();
  const Eigen::Vector2d start = position;
  Alignment sums;
  for (int step = 0; step < kAlignmentSteps; ++step) {
    if (!right.holds(position, reach) || (position - start).norm() > kMaxShift) return std::nullopt;
    const Samples found = cut(right, position, steps);
    if (is_saturated(found)) return std::nullopt;
    const Level found_level = level_of(found);
    if (!(wanted_level.norm > 0 && found_level.norm > 0)) return std::nullopt;
    sums = compare(wanted, wanted_level, found, found_level);
    const double determinant = sums.normal.determinant(), trace = sums.normal.trace();
    if (!(determinant > kMinRoundness * trace * trace)) return std::nullopt;  // an edge, not a corner
    const Eigen::Vector2d move = steps * sums.normal.inverse() * sums.right_side;
    position += move;
    if (move.norm() < kSettledShift) break;
  }
  const Eigen::Matrix2d covariance =
      sums.cost / (kAlignedSide * kAlignedSide - 2) * steps * sums.normal.inverse() * steps.transpose();
  const double sigma = std::sqrt(epipolar->normal.dot(covariance * epipolar->normal));
  if (1 - sums.cost / 2 < kMinCorrelation || sigma > kMaxSigma) return std::nullopt;
  const Eigen::Vector2d from_infinity = position - epipolar->infinity;
  const double along = from_infinity.dot(epipolar->direction);
  return CornerMatch{corner_at,
                     along,
                     from_infinity.dot(epipolar->normal),
                     sigma,
                     true,
                     epipolar->normal,
                     epipolar->inverse_depth(along, t_),
                     position};
}

void CornerMatcher::align(const StereoFrame& frame, const StereoEdges& edges, std::vector<CornerMatch>& matches) const {
  const PinholeView left(frame.left, rig_.left_undistortion, rig_.left),
      right(frame.right, rig_.right_undistortion, rig_.right);
  const std::size_t step = std::max<std::size_t>(edges.size() / kAlignedSpots, 1), first = step / 2;
  matches.resize(edges.size() > first ? (edges.size() - first + step - 1) / step : 0);
  tbb::parallel_for(std::size_t{0}, matches.size(), [&](std::size_t k) {
    const std::size_t i = first + k * step;
    const auto match = refine(left, right, {edges.left_x[i], edges.left_y[i]}, {edges.right_x[i], edges.right_y[i]});
    matches[k] = match.value_or(CornerMatch());
    matches[k].is_aligned = match.has_value();
  });
  matches.erase(
      std::remove_if(matches.begin(), matches.end(), [](const CornerMatch& match) { return !match.is_aligned; }),
      matches.end());
}

/// Reduced images as the left camera would see a scene at infinity, so that only disparity remains.
struct CornerMatcher::CoarseViews {
  double scale;  ///< left pixels per coarse pixel
  GreyPlane left, right;

  /// Position in the left image [px] of a position in a coarse image.
  static Eigen::Vector2d in_left(const Eigen::Vector2d& at, double scale) {
    return scale * at + Eigen::Vector2d::Constant(0.5 * (scale - 1));
  }
  Eigen::Vector2d in_left(const Eigen::Vector2d& at) const { return in_left(at, scale); }
};

CornerMatcher::CoarseViews CornerMatcher::coarse_views(const PinholeView& left, const PinholeView& right) const {
  const double scale = std::max(1.0, std::round(rig_.left.width / kCoarseWidth));
  const int width = static_cast<int>(rig_.left.width / scale), height = static_cast<int>(rig_.left.height / scale);
  const auto in_left = [&](const Eigen::Vector2d& at) { return std::optional(CoarseViews::in_left(at, scale)); };
  return {scale, sample_plane(left, width, height, in_left),
          sample_plane(right, width, height, [&](const Eigen::Vector2d& at) { return at_infinity(*in_left(at)); })};
}

// LONG: seek() says what is done with a corner, and uses all that is prepared before it.
CornerSearch CornerMatcher::search(const StereoFrame& frame, double max_disparity, std::size_t every,
                                   const HiddenPixels& hidden, const GreyPlane* last) const {
  const PinholeView left(frame.left, rig_.left_undistortion, rig_.left),
      right(frame.right, rig_.right_undistortion, rig_.right);
  CoarseViews views = coarse_views(left, right);
  const double scale = views.scale;
  CornerSearch result;
  const Light light_left = light_of(views.left), light_right = light_of(views.right);
  result.brightness = light_right.mean / std::max(1.0, light_left.mean);
  result.more_saturated = std::abs(light_right.saturated - light_left.saturated);
  const double along = std::min(0.5 * rig_.left.width, std::max(kSearchAlong * rig_.left.width, 1.25 * max_disparity)),
               across = kSearchAcross * rig_.left.height;
  const auto seek = [&](const Eigen::Vector2i& corner) {
    SearchedCorner outcome;
    const Eigen::Vector2d corner_at = views.in_left(corner.cast<double>());
    const auto epipolar = line(corner_at);
    if (!epipolar) return outcome;
    // Direction of the line in the coarse images.
    const Eigen::Vector3d ahead = h_.inverse() * (epipolar->infinity + epipolar->direction).homogeneous();
    const Eigen::Vector2d direction = (ahead.hnormalized() - corner_at).normalized();
    const SearchBox box{static_cast<int>((std::abs(direction.x()) * along + std::abs(direction.y()) * across) / scale),
                        static_cast<int>((std::abs(direction.y()) * along + std::abs(direction.x()) * across) / scale)};
    const auto saturates = [](const PinholeView& view, const Eigen::Vector2d& at) {
      return view.holds(at, kAlignedHalf + 1) && is_saturated(cut(view, at, Eigen::Matrix2d::Identity()));
    };
    outcome.is_saturated = saturates(left, corner_at);
    if (outcome.is_saturated) return outcome;
    outcome.has_line = true;
    const auto there = best_match(views.left, views.right, corner, box);
    if (!there) return outcome;
    const Eigen::Vector2i landed = there->at.array().round().cast<int>().matrix();
    const auto back = best_match(views.right, views.left, landed, box);
    if (!back || (back->at - corner.cast<double>()).norm() > 1.5) return outcome;
    outcome.is_negative = there->correlation < 0;
    const auto position = at_infinity(views.in_left(there->at));
    if (outcome.is_negative || !position) return outcome;
    outcome.is_saturated = saturates(right, *position);
    if (outcome.is_saturated) return outcome;
    outcome.found = refine(left, right, corner_at, *position);
    const Eigen::Vector2d from_infinity = *position - epipolar->infinity;
    if (!outcome.found)
      outcome.found = CornerMatch{corner_at,
                                  from_infinity.dot(epipolar->direction),
                                  from_infinity.dot(epipolar->normal),
                                  0.3 * scale,
                                  false,
                                  epipolar->normal,
                                  0,
                                  *position};
    outcome.found->is_unique = there->is_unique && back->is_unique;
    if (last == nullptr) return outcome;
    const int reach = static_cast<int>(kSearchMotion * views.left.width);
    const auto before = best_match(views.left, *last, corner, {reach, reach});
    if (before && before->is_unique && before->correlation > 0)
      outcome.found->motion = scale * (corner.cast<double>() - before->at);
    return outcome;
  };
  auto corners = find_corners(views.left, kCell);
  corners.erase(std::remove_if(corners.begin(), corners.end(),
                               [&](const Eigen::Vector2i& corner) {
                                 const Eigen::Vector2d at = views.in_left(corner.cast<double>());
                                 return hides(hidden.left, at.x(), at.y()) || hides(rig_.left_mask, at.x(), at.y());
                               }),
                corners.end());
  std::vector<SearchedCorner> all((corners.size() + every - 1) / every);
  tbb::parallel_for(std::size_t{0}, all.size(), [&](std::size_t i) { all[i] = seek(corners[i * every]); });
  for (const SearchedCorner& outcome : all) {
    const auto is_hidden_by = [&](const PixelMask& mask) {
      return outcome.found && hides(mask, outcome.found->right.x(), outcome.found->right.y());
    };
    if (is_hidden_by(hidden.right) || is_hidden_by(rig_.right_mask)) continue;
    result.saturated += outcome.is_saturated ? 1 : 0;
    result.searched += outcome.has_line && !outcome.is_saturated ? 1 : 0;
    result.negative += outcome.is_negative ? 1 : 0;
    if (!outcome.found) continue;
    result.aligned += outcome.found->is_aligned ? 1 : 0;
    result.on_line += outcome.found->is_aligned && std::abs(outcome.found->across) < kOnLine ? 1 : 0;
    result.found.push_back(*outcome.found);
  }
  result.left_view = std::move(views.left);
  return result;
}

}  // namespace quadedge::rig
