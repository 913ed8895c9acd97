#include "matching.hpp"
#include "rig/rectification_follower.hpp"

using namespace quadedge;
using namespace matching;
using rig::CornerMatch;
using rig::RectificationFollower;

namespace {

const StereoRig& rig() {
  static const StereoRig rig = flat_rig(640, 480, 600, 0.1);
  return rig;
}

RectificationFollower follower() { return {rig(), StereoConfig{}}; }

/// Matches anywhere in the right image, as far off their lines as `error` says, up to uniform noise [px].
std::vector<CornerMatch> matches_of(const RectificationError& error, Random& random, double noise = 0.15,
                                    int count = 200) {
  std::vector<CornerMatch> matches(static_cast<std::size_t>(count));
  for (CornerMatch& match : matches) {
    const double u = random(-0.5, 0.5), v = random(-0.5, 0.5);
    match.right = {(u + 0.5) * rig().right.width, (v + 0.5) * rig().right.height};
    match.across = error.at(u, v) + random(-noise, noise);
  }
  return matches;
}

/// The error of the frame after so many with this one.
RectificationError next_after(RectificationFollower& follower, const RectificationError& error, int frames = 1,
                              double noise = 0.15, int count = 200) {
  Random random(11);
  for (int frame = 0; frame < frames; ++frame) {
    follower.start_frame();
    follower.observe(matches_of(error, random, noise, count));
  }
  follower.start_frame();
  return follower.error();
}

}  // namespace

TEST_CASE("rectification follower: an error that the images show clearly is followed") {
  const RectificationError error{0.6, 0.4, -0.3, 0, 3, 0};
  auto followed = follower();
  CHECK(followed.error().largest() == 0);
  CHECK((next_after(followed, error, 20) - error).largest() < 0.1);
  CHECK(followed.error().bend_xx == 0);  // noise
  CHECK(followed.error().bend_yy == 0);
  const RectificationError moved{0.9, 0.4, -0.3, 0, 3, 0};
  CHECK((next_after(followed, moved, 400) - moved).largest() < 0.1);
  // Disparities stay comparable.
  const RectificationError before = followed.error();
  CHECK((next_after(followed, {0.92, 0.4, -0.3, 0, 3, 0}, 5) - before).largest() == 0);
}

TEST_CASE("rectification follower: an error that is small, uncertain or measured at few places is not corrected") {
  auto small = follower(), uncertain = follower(), rare = follower();
  CHECK(next_after(small, {0.2, 0, 0, 0, 0, 0}, 30).largest() == 0);
  CHECK(next_after(uncertain, {0.3, 0, 0, 0, 0, 0}, 1, 3).largest() == 0);
  CHECK(next_after(rare, {0.6, 0, 0, 0, 0, 0}, 30, 0.15, 10).largest() == 0);
}

TEST_CASE("rectification follower: an error that explains little of the distances is another fault") {
  auto explained = follower(), unexplained = follower();
  CHECK(next_after(explained, {0.6, 0, 0, 0, 0, 0}, 30, 0.3).offset == Approx(0.6).margin(0.05));
  CHECK(next_after(unexplained, {0.6, 0, 0, 0, 0, 0}, 30, 1.5).largest() == 0);
}

TEST_CASE("rectification follower: no distance above 3 px is corrected") {
  auto followed = follower();
  const RectificationError error = next_after(followed, {4, 1, -1, 0, 0, 0});
  CHECK(error.largest() == Approx(3).epsilon(0.01));
  CHECK(error.offset == Approx(4 * error.slope_x).epsilon(0.1));
}

TEST_CASE("rectification follower: an error that changes from frame to frame is given up") {
  auto followed = follower();
  CHECK(next_after(followed, {0.8, 0, 0, 0, 0, 0}).offset == Approx(0.8).margin(0.05));
  for (int frame = 0; frame < 10; ++frame) next_after(followed, {frame % 2 == 0 ? -0.8 : 0.8, 0, 0, 0, 0, 0});
  CHECK(followed.error().largest() == 0);
}

TEST_CASE("rectification follower: around a limit an error is not taken and given up by turns") {
  auto followed = follower();
  next_after(followed, {0.3, 0, 0, 0, 0, 0}, 5);
  CHECK(next_after(followed, {0.2, 0, 0, 0, 0, 0}, 50).offset == Approx(0.25).margin(0.06));
  CHECK(next_after(followed, {0.05, 0, 0, 0, 0, 0}, 400).largest() == 0);
}
