#include <cstdio>
#include <quadedge/odometry.hpp>
#include <quadedge/synthetic.hpp>

int main() {
  quadedge::SyntheticSequence sequence({"room", 2, 320, 200, 184.0});
  quadedge::Device device("auto");
  quadedge::Config config;
  config.stereo.max_disparity = sequence.max_disparity();
  quadedge::StereoOdometry odometry(sequence.rig(), device, config);
  for (int i = 0; i < sequence.frames(); ++i) {
    const auto left = sequence.render(i, false).image, right = sequence.render(i, true).image;
    const auto result = odometry.track({sequence.stamp_ns(i), left.view(), right.view()});
    std::printf("frame %d: %s, %d edges\n", i, to_string(result.status), result.counts.edges_left);
    if (result.counts.edges_left == 0) return 1;
  }
}
