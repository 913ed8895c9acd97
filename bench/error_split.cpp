/// \file error_split.cpp  Attributes the error of poses to its sources: tracks a rendered scene, then re-estimates each
/// motion with one kind of measurement at a time replaced by ground truth, or with one part of the method changed. The
/// odometry itself never uses ground truth; its quads are modified afterwards.
///
///   error_split room --frames 60          prints a Markdown table

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <functional>

#include "cli/frame_source.hpp"
#include "evaluation/matching_source.hpp"
#include "pose/motion.hpp"
#include "quadedge/error.hpp"
#include "quadedge/odometry.hpp"

namespace {

using namespace quadedge;
using evaluation::TruePositions;
using evaluation::Visibility;

constexpr double kWrong = 1.0;  // limit on the distance of a quad from the truth across its edge, in any image [px]
constexpr double kDegreesPerRadian = 57.295779513082320876798;

/// Errors of one variant, summed over the frames.
struct Errors {
  std::string name;
  int frames = 0;
  double turn = 0, shift = 0;         ///< sums of squares [rad^2, m^2]
  double length = 0, length_sum = 0;  ///< error along the true motion and that motion's length [m]
  double quads = 0;

  void add(const Eigen::Isometry3d& estimate, const Eigen::Isometry3d& truth, std::size_t count) {
    const Eigen::Isometry3d error = truth.inverse() * estimate;
    const Eigen::Vector3d shift_error = estimate.translation() - truth.translation();
    ++frames;
    turn += std::pow(Eigen::AngleAxisd(error.linear()).angle(), 2);
    shift += shift_error.squaredNorm();
    length += shift_error.dot(truth.translation().normalized());
    length_sum += truth.translation().norm();
    quads += static_cast<double>(count);
  }
  void print() const {
    if (frames == 0) return;
    std::printf("| %s | %.2f | %.4f | %+.2f | %.0f |\n", name.c_str(),
                1e3 * kDegreesPerRadian * std::sqrt(turn / frames), 1e3 * std::sqrt(shift / frames),
                100 * length / length_sum, quads / frames);
  }
};

/// Quads as separate rows, so that each can be modified, and the true positions of their ends.
struct Quads {
  StereoEdges before, now;
  TruePositions before_right;         ///< of the earlier left edge in the earlier right image
  TruePositions now_left, now_right;  ///< of the earlier left edge in the later images
  TruePositions now_own_right;        ///< of the later left edge in its right image

  std::size_t size() const { return before.size(); }
};

void append(const StereoEdges& from, std::size_t i, StereoEdges& to) {
  to.left_index.push_back(static_cast<std::int32_t>(to.size()));
  to.right_index.push_back(from.right_index[i]);
  to.left_x.push_back(from.left_x[i]);
  to.left_y.push_back(from.left_y[i]);
  to.left_direction.push_back(from.left_direction[i]);
  to.right_x.push_back(from.right_x[i]);
  to.right_y.push_back(from.right_y[i]);
  to.right_direction.push_back(from.right_direction[i]);
  to.ncc.push_back(from.ncc[i]);
}

EdgePositionsView left_positions(const StereoEdges& edges) {
  return {edges.left_x, edges.left_y, edges.left_direction};
}

/// Distance of a position from a true one, across an edge [px].
double across(double x, double y, double true_x, double true_y, double direction) {
  return std::abs((x - true_x) * std::sin(direction) - (y - true_y) * std::cos(direction));
}

bool known(const Quads& q, std::size_t i) {
  return q.before_right.state[i] == Visibility::visible && q.now_left.state[i] == Visibility::visible &&
         q.now_right.state[i] == Visibility::visible && q.now_own_right.state[i] == Visibility::visible;
}

bool right(const Quads& q, std::size_t i) {
  return across(q.before.right_x[i], q.before.right_y[i], q.before_right.x[i], q.before_right.y[i],
                q.before.right_direction[i]) < kWrong &&
         across(q.now.left_x[i], q.now.left_y[i], q.now_left.x[i], q.now_left.y[i], q.now.left_direction[i]) < kWrong &&
         across(q.now.right_x[i], q.now.right_y[i], q.now_right.x[i], q.now_right.y[i], q.now.right_direction[i]) <
             kWrong;
}

Quads select(const Quads& all, const std::function<bool(const Quads&, std::size_t)>& wanted) {
  Quads kept;
  const auto append_position = [](const TruePositions& from, std::size_t i, TruePositions& to) {
    to.push(from.x[i], from.y[i], from.state[i], from.contour[i] != 0);
  };
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!wanted(all, i)) continue;
    append(all.before, i, kept.before);
    append(all.now, i, kept.now);
    append_position(all.before_right, i, kept.before_right);
    append_position(all.now_left, i, kept.now_left);
    append_position(all.now_right, i, kept.now_right);
    append_position(all.now_own_right, i, kept.now_own_right);
  }
  return kept;
}

/// Replaces the right points by the true ones.
void true_disparities(Quads& q) {
  for (std::size_t i = 0; i < q.size(); ++i) {
    q.before.right_x[i] = q.before_right.x[i];
    q.before.right_y[i] = q.before_right.y[i];
    q.now.right_x[i] = q.now_own_right.x[i];
    q.now.right_y[i] = q.now_own_right.y[i];
  }
}

/// Replaces the later left edges by the true positions of the earlier ones; each right point keeps its error.
void true_motion_of_edges(Quads& q) {
  for (std::size_t i = 0; i < q.size(); ++i) {
    q.now.right_x[i] += q.now_right.x[i] - q.now_own_right.x[i];
    q.now.right_y[i] += q.now_right.y[i] - q.now_own_right.y[i];
    q.now.left_x[i] = q.now_left.x[i];
    q.now.left_y[i] = q.now_left.y[i];
  }
}

/// Removes the mean error of the disparities, the common bias of all frames.
void unbiased_disparities(Quads& q) {
  const auto shift = [](std::vector<float>& found, const std::vector<float>& truth) {
    double sum = 0;
    for (std::size_t i = 0; i < found.size(); ++i)
      sum += std::clamp(static_cast<double>(found[i]) - truth[i], -1.0, 1.0);
    for (float& x : found) x -= static_cast<float>(sum / static_cast<double>(found.size()));
  };
  shift(q.before.right_x, q.before_right.x);
  shift(q.now.right_x, q.now_own_right.x);
}

class Split {
 public:
  Split(const evaluation::MatchingSource& source, const Config& config) : source_(source), config_(config) {
    for (const char* name :
         {"as the odometry has it", "estimated again, disparities taken as exact", "quads of known truth alone",
          "without wrong quads", "disparities without their mean error", "true disparities",
          "true motion of the left edges", "both true: the solver", "no robust weights",
          "as exact along an edge as across it", "no least squares: the best sample alone"}) {
      errors_.push_back({name});
    }
  }

  void add(const FrameResult& result, const FrameDetails& details, const evaluation::FrameTruth& before,
           const evaluation::FrameTruth& now) {
    truth_ = now.world_from_left->inverse() * *before.world_from_left;
    found_ = *result.current_from_reference;
    seed_ = config_.seed + static_cast<std::uint64_t>(errors_[0].frames);
    const Quads all = gather(details, before, now);
    errors_[0].add(found_, truth_, all.size());
    const Quads sure = select(all, known), good = select(sure, right);
    estimate(1, all, config_.pose);
    estimate(2, sure, config_.pose);
    estimate(3, good, config_.pose);
    Quads changed = good;
    unbiased_disparities(changed);
    estimate(4, changed, config_.pose);
    changed = good;
    true_disparities(changed);
    estimate(5, changed, config_.pose);
    changed = good;
    true_motion_of_edges(changed);
    estimate(6, changed, config_.pose);
    true_disparities(changed);
    for (std::size_t i = 0; i < changed.size(); ++i) {  // of the true position of the edge
      changed.now.right_x[i] = changed.now_right.x[i];
      changed.now.right_y[i] = changed.now_right.y[i];
    }
    estimate(7, changed, config_.pose);
    PoseConfig pose = config_.pose;
    pose.student_dof = 1e6;
    estimate(8, all, pose);
    pose = config_.pose;
    pose.sigma_along = pose.sigma_across;
    estimate(9, all, pose);
    pose = config_.pose;
    pose.refine = false;
    pose.local_optimisation_rounds = 0;
    pose.local_optimisation_widening = 1;
    estimate(10, all, pose, false);
  }

  void print() const {
    std::printf(
        "| measurements and method | rotation [mdeg] | translation [mm] | length [%%] | quads "
        "|\n|---|---|---|---|---|\n");
    for (const auto& row : errors_) row.print();
  }

 private:
  Quads gather(const FrameDetails& details, const evaluation::FrameTruth& before,
               const evaluation::FrameTruth& now) const {
    Quads quads;
    for (std::size_t q = 0; q < details.quads.size(); ++q) {
      append(details.previous_stereo, static_cast<std::size_t>(details.quads.previous[q]), quads.before);
      append(details.stereo, static_cast<std::size_t>(details.quads.current[q]), quads.now);
    }
    quads.before_right = true_right_positions(source_.rig(), before, left_positions(quads.before));
    quads.now_left = true_later_positions(source_.rig(), before, now, Side::left, left_positions(quads.before));
    quads.now_right = true_later_positions(source_.rig(), before, now, Side::right, left_positions(quads.before));
    quads.now_own_right = true_right_positions(source_.rig(), now, left_positions(quads.now));
    return quads;
  }

  void estimate(std::size_t row, const Quads& quads, const PoseConfig& pose, bool start = true) {
    Config config = config_;
    config.pose = pose;
    TemporalMatches matches;
    for (std::size_t i = 0; i < quads.size(); ++i) {
      const auto n = static_cast<std::int32_t>(i);
      matches.append(n, n, quads.now, quads.now.ncc[i], 0);
    }
    const auto built = pose::build_quads(source_.rig(), quads.before, quads.now, matches, pose::QuadLimits(config));
    const auto motion =
        pose::estimate_motion(source_.rig(), built, pose, seed_, start ? std::optional(found_) : std::nullopt);
    if (motion.status == pose::MotionStatus::ok) errors_[row].add(motion.current_from_previous, truth_, quads.size());
  }

  const evaluation::MatchingSource& source_;
  Config config_;
  std::vector<Errors> errors_;
  Eigen::Isometry3d truth_, found_;
  std::uint64_t seed_ = 0;
};

/// The error of the odometry's poses, and the part of it that comes from the poses of the key rigs.
struct KeyRigErrors {
  Errors step{"relative to the key rig"}, whole{"relative to the first frame"};
  int keys = 0;
};

/// Tracks all frames with and without key rigs; the first time with `split`.
KeyRigErrors track(const evaluation::MatchingSource& source, Device& device, const Config& config, Split* split) {
  StereoOdometry odometry(source.rig(), device, config);
  KeyRigErrors errors;
  std::vector<evaluation::FrameTruth> truths;
  for (int i = 0; i < source.frames(); ++i) {
    auto frame = source.load(i);
    const auto result = odometry.track(frame.frame.view());
    truths.push_back(std::move(frame.truth));
    errors.keys += result.new_key_rig ? 1 : 0;
    if (result.status != FrameStatus::tracked) continue;
    const auto& before = truths[static_cast<std::size_t>(result.reference_frame)];
    errors.step.add(*result.current_from_reference, truths.back().world_from_left->inverse() * *before.world_from_left,
                    0);
    errors.whole.add(result.world_from_left->inverse(), truths.back().world_from_left->inverse(), 0);
    if (split != nullptr) split->add(result, odometry.details(), before, truths.back());
    // Only the maps of key rigs are evaluated again.
    for (int j = 0; j < i; ++j) {
      if (j != result.reference_frame)
        truths[static_cast<std::size_t>(j)].left = truths[static_cast<std::size_t>(j)].right = {};
    }
  }
  return errors;
}

void print_keys(const char* name, const KeyRigErrors& errors) {
  const auto degrees = [](const Errors& e) { return 1e3 * kDegreesPerRadian * std::sqrt(e.turn / e.frames); };
  const auto metres = [](const Errors& e) { return 1e3 * std::sqrt(e.shift / e.frames); };
  std::printf("| %s | %d | %.2f | %.4f | %.2f | %.4f |\n", name, errors.keys, degrees(errors.step), metres(errors.step),
              degrees(errors.whole), metres(errors.whole));
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App program("Splits the error of the poses on a rendered scene into its causes", "error_split");
  SyntheticOptions scene;
  std::string size;
  program.add_option("SCENE", scene.scene, "room, cables or facade")->required();
  program.add_option("--path", scene.path, "ellipse, handheld, drive or loop");
  program.add_option("--frames", scene.frames, "length of the sequence");
  program.add_option("--size", size, "of the images, WxH; default 942x489");
  program.add_option("--scene-seed", scene.seed, "of textures, cable shapes and camera noise");
  CLI11_PARSE(program, argc, argv);
  try {
    cli::set_size(scene, size);
    const auto source = evaluation::make_rendered_source(scene);
    Config config;
    config.stereo.max_disparity = source->rig().max_disparity;
    Device device;
    Split split(*source, config);
    const KeyRigErrors with = track(*source, device, config, &split);
    config.odometry.key_rig = false;
    const KeyRigErrors without = track(*source, device, config, nullptr);
    std::printf("%s, %d frames: root mean square errors of the motions since the key rig\n\n", scene.scene.c_str(),
                scene.frames);
    split.print();
    std::printf(
        "\n| reference | key rigs | step: rotation [mdeg] | translation [mm] | whole way: rotation [mdeg] | "
        "translation [mm] |\n|---|---|---|---|---|---|\n");
    print_keys("key rigs", with);
    print_keys("the frame before", without);
    return 0;
  } catch (const Error& error) {
    std::fprintf(stderr, "error_split: %s\n", error.what());
    return static_cast<int>(error.exit_code());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error_split: internal error: %s\n", error.what());
    return static_cast<int>(ExitCode::internal);
  }
}
