/// \file bench_undistortion.cpp  Undistortion of both images, with a table that moves every pixel by a fraction.
#include "stage_bench.hpp"

namespace {

quadedge::UndistortionTable shifting_table(const quadedge::PinholeCamera& camera) {
  quadedge::UndistortionTable table{camera.width, camera.height, {}, {}};
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      table.source_x.push_back(static_cast<float>(x) + 0.25f);
      table.source_y.push_back(static_cast<float>(y) + 0.25f);
    }
  }
  return table;
}

void distort(quadedge::Config&, quadedge::StereoRig& rig) {
  rig.left_undistortion = shifting_table(rig.left);
  rig.right_undistortion = shifting_table(rig.right);
}

[[maybe_unused]] const bool registered = stage_bench::register_stage("undistortion", distort);

}  // namespace
