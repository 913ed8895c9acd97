/// \file sequence_writer.cpp  Rendered images, depths, cameras and poses in the layout of ETH3D's SLAM benchmark.
#include "data/sequence_writer.hpp"

#include <filesystem>

#include "data/atomic_file.hpp"
#include "data/image_file.hpp"
#include "data/text.hpp"
#include "quadedge/calibration.hpp"
#include "quadedge/trajectory.hpp"

namespace quadedge {
namespace {

namespace fs = std::filesystem;

/// A PFM: little-endian, from the bottom row up.
void write_depths(const fs::path& file, const RenderedView& view) {
  const int width = view.image.width, height = view.image.height;
  std::string bytes = "Pf\n" + std::to_string(width) + " " + std::to_string(height) + "\n-1\n";
  for (int y = height - 1; y >= 0; --y)
    bytes.append(reinterpret_cast<const char*>(view.depth.data() + static_cast<std::ptrdiff_t>(y) * width),
                 static_cast<std::size_t>(width) * sizeof(float));
  data::write_atomically(file.string(), bytes);
}

std::string camera_row(const PinholeCamera& camera) {
  return data::format_exact(camera.fx) + ' ' + data::format_exact(camera.fy) + ' ' + data::format_exact(camera.cx) +
         ' ' + data::format_exact(camera.cy) + '\n';
}

std::string matrix_rows(const Eigen::Isometry3d& transform) {
  std::string rows;
  for (int i = 0; i < 12; ++i) rows += data::format_exact(transform.matrix()(i / 4, i % 4)) + (i % 4 == 3 ? '\n' : ' ');
  return rows;
}

}  // namespace

void write_eth3d_slam(const std::string& folder, const SyntheticSequence& sequence,
                      const std::function<void(int, int)>& progress) {
  const fs::path root(folder);
  if (fs::exists(root / "rgb") || fs::exists(root / "rgb2")) {
    data::fail(folder, "an existing sequence", "an empty or new folder");
  }
  for (const char* name : {"rgb", "rgb2", "depth", "depth2"}) data::make_folder(root / name);
  const StereoRig& rig = sequence.rig();
  const bool is_left_first = sequence.options().rig == "rectified";
  const Side first = is_left_first ? Side::left : Side::right;
  if (sequence.calibration().left.is_pinhole()) {
    data::write_atomically((root / "calibration.txt").string(), camera_row(is_left_first ? rig.left : rig.right));
    data::write_atomically((root / "calibration2.txt").string(), camera_row(is_left_first ? rig.right : rig.left));
    data::write_atomically((root / "extrinsics_1_2.txt").string(),
                           matrix_rows(is_left_first ? rig.right_from_left.inverse() : rig.right_from_left));
  } else {
    write_calibration((root / "calibration.yaml").string(), sequence.calibration());
  }
  std::string list = "# timestamp filename\n";
  Trajectory truth;
  for (int frame = 0; frame < sequence.frames(); ++frame) {
    const std::string stamp = data::format_seconds(sequence.stamp_ns(frame));
    for (const Side side : kSides) {
      const bool second = side != first;
      const RenderedView view = sequence.render(frame, side);
      data::write_atomically((root / (second ? "rgb2" : "rgb") / (stamp + ".png")).string(),
                             data::encode_png(data::matrix_of(view.image)));
      write_depths(root / (second ? "depth2" : "depth") / (stamp + ".pfm"), view);
    }
    list += stamp + " rgb/" + stamp + ".png\n";
    const Eigen::Isometry3d world_from_left = sequence.world_from_left(frame);
    truth.push_back(
        {sequence.stamp_ns(frame), is_left_first ? world_from_left : world_from_left * rig.right_from_left.inverse()});
    if (progress) progress(frame + 1, sequence.frames());
  }
  write_tum((root / "groundtruth.txt").string(), truth);
  data::write_atomically((root / "rgb.txt").string(), list);
}

}  // namespace quadedge
