/// \file test_paper_refinement.cpp  The refinement of the paper's method on every device, against the plain form.
#include "common/matching_constants.hpp"
#include "common/numeric.hpp"
#include "geometry/disparity_range.hpp"
#include "paper_lists.hpp"
#include "reference/stereo_matching.hpp"

using namespace quadedge;
using namespace matching;

namespace {

constexpr double kPatchOffset = 5;

StereoConfig paper_config(bool both_sides) {
  StereoConfig config;
  config.refine_steps = 20;
  config.refine_tolerance = 1e-3;
  config.refine_sides = both_sides ? "both" : "best";
  return config;
}

paper::Place place_of(const EdgeSet& edges, std::size_t i) { return {edges.x[i], edges.y[i], edges.direction[i]}; }

using Refine = std::function<Eigen::Vector2d(std::size_t, std::size_t, double)>;

/// Plain refinements of all candidates: refine(i, j, nudge) of row i and target j, from a start `nudge` px aside. NaN
/// where a start as far away as single precision rounds leads elsewhere: not converged, or between two minima.
std::vector<Eigen::Vector2d> plain(const PaperLists& lists, const Refine& refine) {
  constexpr double kRounding = 5e-5, kElsewhere = 1e-3;  // px
  std::vector<Eigen::Vector2d> refined(lists.candidates.target.size());
  for (std::size_t i = 0; i + 1 < lists.candidates.first.size(); ++i)
    for (auto c = static_cast<std::size_t>(lists.candidates.first[i]);
         c < static_cast<std::size_t>(lists.candidates.first[i + 1]); ++c) {
      const auto j = static_cast<std::size_t>(lists.candidates.target[c]);
      refined[c] = refine(i, j, 0);
      for (const double nudge : {-kRounding, kRounding})
        if (!((refine(i, j, nudge) - refined[c]).norm() < kElsewhere)) refined[c].setConstant(std::nan(""));
    }
  return refined;
}

/// Single precision may end a refinement a step earlier or later, which moves it by less than the tolerance.
void compare(const PaperLists& lists, const std::vector<Eigen::Vector2d>& truth, const std::vector<float>& found) {
  std::size_t alive = 0, steady = 0, different = 0;
  const std::size_t stride = found.size() / 2;
  for (std::size_t c = 0; c < truth.size(); ++c) {
    if (lists.scores.state[c] != kCandidateAlive) continue;
    ++alive;
    if (!truth[c].allFinite()) continue;
    ++steady;
    const Eigen::Vector2d at(static_cast<double>(found[c]), static_cast<double>(found[stride + c]));
    different += (at - truth[c]).norm() < 2e-3 ? 0 : 1;
  }
  CHECK(alive > truth.size() / 2);
  CHECK(steady > alive / 2);
  CHECK(different == 0);
}

using Run = std::function<void(stages::PaperRefinement&, const stages::PaperEdges&, const stages::PaperEdges&,
                               const stages::DeviceCandidates&, opencl::Buffer<cl_float>&)>;

void on_every_device(const Image& fixed, const Image& moving, const PaperLists& lists, const StereoConfig& config,
                     const std::vector<Eigen::Vector2d>& truth, const Run& run) {
  INFO("sides " << config.refine_sides << ", values to " << fixed.max_value);
  check_stage("paper_refinement", [&](opencl::Context& context, const Variants& variants) -> StageArrays {
    const PaperOnDevice a(context, fixed, lists.fixed, kPatchOffset), b(context, moving, lists.moving, kPatchOffset);
    auto candidates = upload(context, lists.candidates);
    upload(context, lists.scores, candidates);
    stages::PaperRefinement stage(context, config, variants, fixed.max_value);
    opencl::Buffer<cl_float> refined;
    refined.write(context, std::vector<float>(2 * truth.size()));
    run(stage, a.view(), b.view(), candidates, refined);
    const auto positions = refined.read(2 * truth.size());
    compare(lists, truth, positions);
    return {{"positions", positions}};
  });
}

void compare_stereo(const StereoRig& rig, bool both_sides, int max_value) {
  const StereoConfig config = paper_config(both_sides);
  const EpipolarGeometry geometry = make_epipolar_geometry(rig, with_disparity_range({}, rig).stereo);
  const Image left = paper_image(rig.left.width, rig.left.height, 0, 0, max_value),
              right = paper_image(rig.right.width, rig.right.height, -1.3, 0.2, max_value);
  const auto lists = paper_lists(rig.left.width, rig.left.height, 403, 6, 3, [&](float x, float y) {
    const EpipolarLine line = epipolar_line(geometry, x, y);
    return std::array<double, 2>{line.x + 1.3 * line.ex, line.y + 1.3 * line.ey};
  });
  const paper::Picture in_left(left.view()), in_right(right.view());
  const auto truth = plain(lists, [&](std::size_t i, std::size_t j, double nudge) {
    const EpipolarLine line = epipolar_line(geometry, lists.fixed.x[i], lists.fixed.y[i]);
    const auto at = place_of(lists.moving, j);
    const double s = nudge + reference::epipolar_shift(line, at.x, at.y, at.direction, kShiftMinAngle, kShiftMax);
    paper::Place start{static_cast<float>(line.x + s * line.ex), static_cast<float>(line.y + s * line.ey),
                       lists.fixed.direction[i]};
    std::vector<paper::Pairing> pairings = paper::kBothSides;
    if (!both_sides) {
      pairings = {paper::best_pairing(paper::cut_sides(in_left, place_of(lists.fixed, i), kPatchOffset),
                                      paper::cut_sides(in_right, at, kPatchOffset))};
      if (angle_between(start.direction, at.direction) > static_cast<float>(kPi / 2))
        start.direction += static_cast<float>(kPi);
    }
    const auto fixed = paper::cut_sides(in_left, place_of(lists.fixed, i), kPaperRefinementOffset);
    return paper::refine(fixed, pairings, in_right, start, Eigen::Vector2d(line.ex, line.ey),
                         paper::refinement_settings(config))
        .position;
  });
  on_every_device(left, right, lists, config, truth,
                  [&](stages::PaperRefinement& stage, const stages::PaperEdges& a, const stages::PaperEdges& b,
                      const stages::DeviceCandidates& candidates,
                      opencl::Buffer<cl_float>& refined) { stage.in_stereo(a, b, geometry, candidates, refined); });
}

void compare_time(bool both_sides, int max_value, int rows = 403) {
  const StereoConfig config = paper_config(both_sides);
  const int width = 131, height = 97;
  const Image before = paper_image(width, height, 0, 0, max_value),
              now = paper_image(width, height, 0.7, -0.4, max_value);
  const auto lists = paper_lists(width, height, rows, 6, 5, [](float x, float y) {
    return std::array<double, 2>{x + 0.7, y - 0.4};
  });
  const paper::Picture in_before(before.view()), in_now(now.view());
  std::size_t stayed = 0;
  const auto truth = plain(lists, [&](std::size_t i, std::size_t j, double nudge) {
    const auto from = place_of(lists.fixed, i);
    auto start = place_of(lists.moving, j);
    start.x += static_cast<float>(nudge);
    const auto pairings = both_sides ? paper::kBothSides
                                     : std::vector{paper::best_pairing(paper::cut_sides(in_before, from, kPatchOffset),
                                                                       paper::cut_sides(in_now, start, kPatchOffset))};
    const auto found = paper::refine(paper::cut_sides(in_before, from, kPaperRefinementOffset), pairings, in_now, start,
                                     Eigen::Matrix2d::Identity(), paper::refinement_settings(config));
    if (found.rms <= kPaperLargestResidual) return found.position;
    stayed += nudge == 0 ? 1 : 0;
    return Eigen::Vector2d(start.x, start.y);
  });
  CHECK((stayed > 0 || rows < 100));
  on_every_device(before, now, lists, config, truth,
                  [](stages::PaperRefinement& stage, const stages::PaperEdges& a, const stages::PaperEdges& b,
                     const stages::DeviceCandidates& candidates,
                     opencl::Buffer<cl_float>& refined) { stage.in_time(a, b, candidates, refined); });
}

}  // namespace

TEST_CASE("paper refinement: along epipolar lines as the plain form", "[device]") {
  compare_stereo(flat_rig(131, 97), true, kMaxValue8);
  compare_stereo(flat_rig(131, 97), false, kMaxValue8);
  compare_stereo(crooked_rig(), true, kMaxValue8);
  compare_stereo(crooked_rig(), true, 4095);
}

TEST_CASE("paper refinement: a few candidates freely in the image", "[device][oclgrind]") {
  compare_time(true, kMaxValue8, 5);
}

TEST_CASE("paper refinement: freely in the image as the plain form", "[device]") {
  compare_time(true, kMaxValue8);
  compare_time(false, kMaxValue8);
  compare_time(true, 65535);
}
