#include "frontend/rectification_follower.hpp"
#include "matching.hpp"

using namespace quadedge;
using namespace matching;
using frontend::RectificationFollower;
using rig::EpipolarFit;

namespace {

EpipolarFit fit_of(double offset, double slope_x = 0, double slope_y = 0, double scatter = 0.03, int samples = 200) {
  EpipolarFit fit;
  fit.offset = offset;
  fit.slope_x = slope_x;
  fit.slope_y = slope_y;
  fit.residual = std::abs(offset) + 0.25 * (std::abs(slope_x) + std::abs(slope_y)) + scatter;
  fit.scatter = scatter;
  fit.samples = samples;
  return fit;
}

/// The error of the next frame.
RectificationError next_after(RectificationFollower& follower, const EpipolarFit& fit, int frames = 1) {
  for (int frame = 0; frame < frames; ++frame) {
    follower.start_frame();
    follower.take(fit);
  }
  follower.start_frame();
  return follower.error();
}

const StereoRig& rig() {
  static const StereoRig rig = flat_rig(640, 480, 600, 0.1);
  return rig;
}

RectificationFollower follower() { return {rig(), StereoConfig{}}; }

}  // namespace

TEST_CASE("rectification follower: an error that the images show clearly is followed", "[frontend]") {
  auto followed = follower();
  CHECK(followed.error().largest() == 0);
  const RectificationError first = next_after(followed, fit_of(0.6, 0.2, -0.3));
  CHECK(first.offset == 0.6);
  CHECK(first.slope_x == Approx(0.2).margin(0.02));
  CHECK(first.slope_y == Approx(-0.3).margin(0.02));
  CHECK(next_after(followed, fit_of(0.62, 0.2, -0.3), 5).offset == 0.6);  // disparities stay comparable
  auto level = follower();
  CHECK(next_after(level, fit_of(0.6, 0.04, -0.04)).slope_x == 0);  // noise
  CHECK(next_after(followed, fit_of(0.8, 0.2, -0.3), 60).offset == Approx(0.8).margin(0.06));
}

TEST_CASE("rectification follower: an error that is small, uncertain or measured at few places is not corrected",
          "[frontend]") {
  for (const EpipolarFit& fit :
       {fit_of(0.2), fit_of(0.1, 0.1, 0.1), fit_of(0.4, 0, 0, 0.3), fit_of(0.6, 0, 0, 0.03, 30)}) {
    auto followed = follower();
    CHECK(next_after(followed, fit, 30).largest() == 0);
  }
}

TEST_CASE("rectification follower: no distance above 2 px is corrected", "[frontend]") {
  auto followed = follower();
  const RectificationError error = next_after(followed, fit_of(3, 1, -1));
  CHECK(error.largest() == Approx(2).epsilon(0.01));
  CHECK(error.offset == Approx(3 * error.slope_x).epsilon(0.01));
}

TEST_CASE("rectification follower: an error that changes from frame to frame is given up", "[frontend]") {
  auto followed = follower();
  CHECK(next_after(followed, fit_of(0.8)).offset == 0.8);
  for (int frame = 0; frame < 10; ++frame) next_after(followed, fit_of(frame % 2 == 0 ? -0.8 : 0.8));
  CHECK(followed.error().largest() == 0);
}

TEST_CASE("rectification follower: around a limit an error is not taken and given up by turns", "[frontend]") {
  auto followed = follower();
  next_after(followed, fit_of(0.3), 5);
  CHECK(next_after(followed, fit_of(0.2), 50).offset == Approx(0.25).margin(0.06));
  CHECK(next_after(followed, fit_of(0.05), 100).largest() == 0);
}

TEST_CASE("rectification follower: frames that are not taken leave no trace", "[frontend]") {
  auto one = follower(), other = follower();
  next_after(one, fit_of(0.5), 3);
  next_after(other, fit_of(0.5), 2);
  const Image grey(640, 480);
  other.start_frame();
  CHECK(other.suffices({0, grey.view(), grey.view()}, {}));
  other.start_frame();
  other.take(fit_of(0.5));
  other.start_frame();
  CHECK(other.error().offset == one.error().offset);
}
