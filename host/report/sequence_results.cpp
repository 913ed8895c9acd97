#include "report/sequence_results.hpp"

#include <algorithm>
#include <filesystem>

#include "quadedge/error.hpp"

namespace quadedge::report {
namespace fs = std::filesystem;
namespace {

constexpr std::int64_t kToleranceNs = 10'000'000;  // as evaluate_trajectory matches

/// The first pose of `poses` that has one of (nearly) the same time in `others`, and that one.
std::optional<std::pair<StampedPose, StampedPose>> first_match(const Trajectory& poses, const Trajectory& others) {
  const auto earlier = [](const StampedPose& pose, std::int64_t stamp) { return pose.stamp_ns < stamp; };
  for (const auto& pose : poses) {
    auto near = std::lower_bound(others.begin(), others.end(), pose.stamp_ns, earlier);
    if (near != others.begin() &&
        (near == others.end() || pose.stamp_ns - std::prev(near)->stamp_ns < near->stamp_ns - pose.stamp_ns)) {
      --near;
    }
    if (near != others.end() && std::abs(near->stamp_ns - pose.stamp_ns) <= kToleranceNs)
      return std::make_pair(pose, *near);
  }
  return std::nullopt;
}

void move(Trajectory& poses, const Eigen::Isometry3d& motion) {
  for (auto& pose : poses) pose.world_from_left = motion * pose.world_from_left;
}

/// Moves a trajectory so that it agrees with the reference at the first time that both know.
bool align_origin(Trajectory& poses, const Trajectory& reference) {
  const auto match = first_match(poses, reference);
  if (match) move(poses, match->second.world_from_left * match->first.world_from_left.inverse());
  return match.has_value();
}

/// Evaluates a trajectory and moves it into the world of the plots. Says in `notes` when that is not possible.
void add_trajectory(SequenceResults& results, const std::string& name, Trajectory poses, const Trajectory& raw_truth) {
  ComparedTrajectory compared{name, std::move(poses), std::nullopt};
  if (!raw_truth.empty()) {
    try {
      compared.evaluation = evaluate_trajectory(compared.poses, raw_truth);
    } catch (const DataError& problem) {
      results.notes.push_back(name + ": " + problem.what());
    }
  }
  const bool first = results.trajectories.empty();
  const Trajectory& reference = results.truth.empty() && !first ? results.trajectories.front().poses : results.truth;
  if (!reference.empty() && !align_origin(compared.poses, reference)) {
    if (raw_truth.empty()) results.notes.push_back(name + ": no pose has a time of this sequence");
    if (!first) return;
  }
  results.trajectories.push_back(std::move(compared));
}

/// The file of a peer's trajectory; empty where there is none.
std::string peer_file(const Peer& peer, const std::string& name) {
  const fs::path folder(name), of_batch = fs::path("sequences") / name;
  for (const fs::path& file : {fs::path(name + ".txt"), folder / "trajectory.txt", of_batch / "trajectory.txt"}) {
    std::error_code ignored;
    if (fs::is_regular_file(fs::path(peer.folder) / file, ignored)) return (fs::path(peer.folder) / file).string();
  }
  return {};
}

std::vector<std::string> thumbnails(const fs::path& folder) {
  std::vector<std::string> files;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    if (entry->path().filename().string().rfind("thumbnail_", 0) == 0) files.push_back(entry->path().string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

/// Adds the trajectory of another system or batch; a note where the file cannot be read.
bool add_other(SequenceResults& results, const std::string& name, const std::string& file, const Trajectory& truth) {
  Trajectory poses;
  try {
    poses = read_tum(file);
  } catch (const DataError& problem) {
    results.notes.push_back(name + ": " + problem.what());
    return false;
  }
  add_trajectory(results, name, std::move(poses), truth);
  return true;
}

}  // namespace

std::optional<SummaryAccuracy> ComparedTrajectory::accuracy() const {
  if (!evaluation) return std::nullopt;
  return SummaryAccuracy{evaluation->origin_aligned, evaluation->se3_aligned, evaluation->matched,
                         evaluation->path_length_m, evaluation->end_drift_percent};
}

SequenceResults read_sequence_results(const std::string& output, const std::string& name, double min_tracked,
                                      const std::string& baseline, const std::vector<Peer>& peers) {
  SequenceResults results;
  const fs::path folder = member_folder(output, name);
  results.row = read_summary_row(folder.string(), name, min_tracked);
  if (!results.ran()) return results;
  Trajectory truth, estimate;
  try {
    results.frames = read_frames_table((folder / "frames.csv").string());
    estimate = read_tum((folder / "trajectory.txt").string());
    if (fs::is_regular_file(folder / "groundtruth.txt")) truth = read_tum((folder / "groundtruth.txt").string());
  } catch (const DataError& problem) {
    results.row = damaged(results.row, problem.what());
    return results;
  }
  results.thumbnails = thumbnails(folder / "pictures");
  results.truth = truth;
  if (const auto match = first_match(estimate, truth)) move(results.truth, match->second.world_from_left.inverse());
  add_trajectory(results, "QuadEdge", std::move(estimate), truth);
  if (!baseline.empty()) {
    const std::string other = member_folder(baseline, name);
    const auto row = read_summary_row(other, name, min_tracked);
    const bool ran = row.status == MemberStatus::done || row.status == MemberStatus::too_few_tracked;
    if (ran && add_other(results, "baseline", other + "/trajectory.txt", truth)) results.baseline = row;
  }
  for (const auto& peer : peers) {
    if (const auto file = peer_file(peer, name); !file.empty()) {
      add_other(results, peer.name, file, truth);
    } else {
      results.notes.push_back(peer.name + ": no " + name + ".txt in " + peer.folder);
    }
  }
  return results;
}

}  // namespace quadedge::report
