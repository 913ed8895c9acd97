#include "matching.hpp"
#include "motion/learned_rig.hpp"

using namespace quadedge;
using rig::LearnedRig;

namespace {

pose::PoseAndOffset learned(double offset, double variance, double shared) {
  pose::PoseAndOffset result;
  result.offset = offset;
  result.offset_variance = variance;
  result.offset_shared = shared;
  return result;
}

RigEstimate displaced(double by, double sigma) {
  RigEstimate rig;
  rig.displacement = by;
  rig.displacement_sigma = sigma;
  return rig;
}

}  // namespace

TEST_CASE("learned rig: motions show how large disparity errors are, standstill does not") {
  LearnedRig rig((PoseConfig()));
  const double prior = rig.estimate().disparity_error;
  const auto after = [&](int frames, double variance, double information) {
    pose::PoseAndOffset motion;
    motion.errors = {variance, information};
    for (int k = 0; k < frames; ++k) rig.anchored(LearnedRig::refined(rig.estimate(), {}, motion));
    return rig.estimate().disparity_error;
  };
  CHECK(after(100, 2.25, 1.3) == prior);
  CHECK(after(100, 0.25, 20) == Approx(0.5).margin(0.03));
  CHECK(after(1, 4, 20) == Approx(0.5).margin(0.03));  // a single motion shows little
  rig.restart();
  CHECK(rig.estimate().disparity_error == prior);
  CHECK(after(10, -0.02, 50) < 0.05);   // by chance, quads may scatter less where a disparity error would show
  CHECK(after(1000, 0.36, 100) > 0.4);  // the rig has been hit
}

TEST_CASE("learned rig: offset and displacement share what is learned of their difference") {
  RigEstimate frame = displaced(2, 0.4);
  frame.disparity_offset_sigma = 0.3;
  // A measurement without noise of 0.25 px.
  const RigEstimate shared = LearnedRig::refined(frame, frame, learned(0.25, 1e-12, 0));
  CHECK(shared.added_disparity() == Approx(frame.added_disparity() + 0.25));
  CHECK(shared.disparity_offset == Approx(0.25 * 0.09 / 0.25));
  CHECK(shared.displacement == Approx(2 - 0.25 * 0.16 / 0.25));
  // Each is as certain as the other was.
  CHECK(shared.disparity_offset_sigma == Approx(0.3 * 0.4 / 0.5));
  CHECK(shared.displacement_sigma == Approx(0.3 * 0.4 / 0.5));
  const RigEstimate alone = LearnedRig::refined(frame, {}, learned(0.25, 0.01, 0));
  CHECK(alone.disparity_offset == 0.25);
  CHECK(alone.displacement == 2);
}

TEST_CASE("learned rig: displacements measured from frame to frame do not walk away") {
  LearnedRig rig((PoseConfig()));
  matching::Random random(3);
  double truth = 0, largest = 0, squares = 0;
  RigEstimate base;
  constexpr int kFrames = 2000;
  for (int frame = 0; frame < kFrames; ++frame) {
    const double before = truth;
    truth = random(-1, 1);
    const double measured = base.displacement + truth - before + random(-0.2, 0.2);
    const double sigma = std::hypot(base.displacement_sigma, 0.12);
    base = rig.anchored(displaced(measured, sigma));
    const double error = base.displacement - truth;
    largest = std::max(largest, std::abs(error));
    squares += error * error;
    CHECK(base.displacement_sigma < 0.5);
  }
  CHECK(std::sqrt(squares / kFrames) < 0.4);  // added up, the errors of 2000 frames have a deviation of 5 px
  CHECK(largest < 1.2);
}

TEST_CASE("learned rig: the first displaced images have to be clear, and a rigid rig has none") {
  LearnedRig rig((PoseConfig()));
  const auto strict = rig.displacement_limits();
  for (int frame = 0; frame < 100; ++frame) CHECK(rig.anchored({}).displacement == 0);
  CHECK(rig.displacement_limits().least == strict.least);
  for (int frame = 0; frame < 2; ++frame) CHECK(rig.anchored(displaced(2, 0.1)).displacement != 0);
  CHECK(rig.displacement_limits().least < strict.least);
  CHECK(rig.displacement_limits().gain < strict.gain);
  rig.restart();
  CHECK(rig.displacement_limits().least == strict.least);
}
