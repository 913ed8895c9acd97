#include "odometry/key_rig.hpp"

#include <algorithm>
#include <cmath>

namespace quadedge::odometry {
namespace {

constexpr double kDegree = 3.14159265358979323846 / 180.0;

}  // namespace

void KeyRig::start(int frame, const Eigen::Isometry3d& world_from_key, const StereoEdges& edges) {
  frame_ = frame;
  world_from_key_ = world_from_key;
  edges_ = edges;
  chains_.clear();
  for (std::size_t i = 0; i < edges.size(); ++i) {
    chains_.push_back({static_cast<std::int32_t>(i), static_cast<std::int32_t>(i), 1.0f, 0});
  }
  first_count_ = 0;
  extended_ = false;
}

void KeyRig::extend(const TemporalMatches& matches) {
  std::vector<std::int32_t> match_of;  // previous stereo edge -> row of matches, -1: none
  for (std::size_t row = 0; row < matches.size(); ++row) {
    const auto previous = static_cast<std::size_t>(matches.previous[row]);
    if (previous >= match_of.size()) match_of.resize(previous + 1, -1);
    match_of[previous] = static_cast<std::int32_t>(row);
  }
  std::vector<Chain> living;
  for (const Chain& chain : chains_) {
    const auto latest = static_cast<std::size_t>(chain.latest);
    if (latest >= match_of.size() || match_of[latest] < 0) continue;
    const auto row = static_cast<std::size_t>(match_of[latest]);
    living.push_back({chain.key, matches.current[row], std::min(chain.ncc, matches.ncc[row]), std::max(chain.rivals, matches.rivals[row])});
  }
  chains_ = std::move(living);
  if (!extended_) first_count_ = static_cast<int>(chains_.size());
  extended_ = true;
}

TemporalMatches KeyRig::chained(const StereoEdges& current) const {
  TemporalMatches matches;
  for (const Chain& chain : chains_) {
    const auto j = static_cast<std::size_t>(chain.latest);
    matches.previous.push_back(chain.key);
    matches.current.push_back(chain.latest);
    matches.left_x.push_back(current.left_x[j]);
    matches.left_y.push_back(current.left_y[j]);
    matches.right_x.push_back(current.right_x[j]);
    matches.right_y.push_back(current.right_y[j]);
    matches.ncc.push_back(chain.ncc);
    matches.rivals.push_back(chain.rivals);
  }
  return matches;
}

double KeyRig::median_parallax(const TemporalMatches& chained) const {
  std::vector<double> distances;
  for (std::size_t row = 0; row < chained.size(); ++row) {
    const auto key = static_cast<std::size_t>(chained.previous[row]);
    distances.push_back(std::hypot(chained.left_x[row] - edges_.left_x[key], chained.left_y[row] - edges_.left_y[key]));
  }
  if (distances.empty()) return 0;
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::nth_element(distances.begin(), middle, distances.end());
  return *middle;
}

bool KeyRig::is_worn(const KeyRigState& state, const OdometryConfig& config) const {
  return state.chained_quads < config.key_min_share * first_count_ || state.chained_quads < config.key_min_quads ||
         state.inlier_share < config.key_min_inlier_share || state.median_parallax > config.key_max_parallax ||
         state.rotation > config.key_max_rotation * kDegree || state.frames >= config.key_max_frames;
}

}  // namespace quadedge::odometry
