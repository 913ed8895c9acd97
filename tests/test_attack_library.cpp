/// \file test_attack_library.cpp  Attacks on the C++ interface. A row holds an invalid call and the error that it
/// throws.
/// To add an attack, add a row.

#include "benchmark/variant_comparison.hpp"
#include "calibration_files.hpp"
#include "frontends.hpp"

using namespace quadedge;
using Catch::Matchers::Contains;

namespace {

/// The arguments of a call: valid until the row changes them.
struct Caller {
  matching::RenderedScene scene{"room", 160, 100, 2};
  Device device{"reference"};
  StereoRig rig = scene.rig;
  Config config = scene.config;
  StereoFrame frame = scene.frame(0);
  const Image small = Image(80, 60), deep = Image(160, 100, 65535);
  TemporaryFolder folder;

  void track() { StereoOdometry(rig, device, config).track(frame); }
  void distort() {
    StereoCalibration calibration = pinhole_calibration(rig);
    calibration.left.model = calibration.right.model = LensModel::radial_tangential;
    calibration.left.parameters = calibration.right.parameters = {-0.1, 0, 0, 0};
    rig = make_rig(calibration);
  }
};

StampedPose pose_at(std::int64_t stamp_ns) {
  StampedPose pose;
  pose.stamp_ns = stamp_ns;
  return pose;
}

struct LibraryAttack {
  std::string name;
  std::function<void(Caller&)> call;  ///< may only change an argument: a frame is tracked next
  std::string words;
  enum { data, usage, device } error = data;
};

/// LONG: one row per attack.
const std::vector<LibraryAttack>& library_attacks() {
  constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();
  using C = Caller&;
  static const std::vector<LibraryAttack> attacks = {
      {"no left image", [](C c) { c.frame.left = {}; }, "left"},
      {"no right image", [](C c) { c.frame.right = {}; }, "right"},
      {"an image of another size", [](C c) { c.frame.left = c.small.view(); }, "80"},
      {"an image of another size than the distorted one of the calibration",
       [](C c) { c.distort(), c.frame.left = c.small.view(); }, "80x60 pixels, the calibration expects 160x100"},
      {"an image of another bit depth", [](C c) { c.frame.right = c.deep.view(); }, "right"},
      {"images of another bit depth than the rig's", [](C c) { c.rig.max_value = 65535; }, "65535"},
      {"rows that overlap", [](C c) { c.frame.left.stride = 159; },
       "left image has a stride of 159 bytes, expected at least the 160"},
      {"rows that overlap, for edges alone",
       [](C c) {
         c.frame.left.stride = 159;
         detect_edges(c.frame.left, c.device, c.config);
       },
       "159"},
      {"rows that are one", [](C c) { c.frame.right.stride = 0; }, "right image has a stride of 0 bytes"},
      {"rows that run backwards", [](C c) { c.frame.left.stride = -160; }, "stride of -160"},
      {"rows of words that overlap",
       [](C c) {
         c.rig.max_value = 65535;
         c.frame.left = c.frame.right = c.deep.view();
         c.frame.right.stride = 319;
       },
       "right image has a stride of 319 bytes, expected at least the 320"},
      {"no baseline", [](C c) { c.rig.right_from_left.setIdentity(); }, "baseline"},
      {"an infinite baseline",
       [](C c) { c.rig.right_from_left.translation().x() = -std::numeric_limits<double>::infinity(); }, ""},
      {"a baseline in millimetres, without a disparity range",
       [](C c) {
         c.rig.right_from_left.translation() *= 1000;
         c.rig.max_disparity = 0;
         c.config = {};
       },
       "baseline"},
      {"a negative disparity range", [](C c) { c.rig.max_disparity = -1; }, "-1"},
      {"a disparity range that is no number", [](C c) { c.rig.max_disparity = kNoNumber; }, "maximum disparity"},
      {"a focal length of zero", [](C c) { c.rig.left.fx = 0; }, ""},
      {"a focal length of NaN", [](C c) { c.rig.right.fy = kNoNumber; }, ""},
      {"an invalid rotation", [](C c) { c.rig.right_from_left.linear() *= 2; }, ""},
      {"a mirrored rotation", [](C c) { c.rig.right_from_left.linear()(2, 2) = -1; }, "right-handed"},
      {"a rotation with NaN", [](C c) { c.rig.right_from_left.linear()(1, 2) = kNoNumber; }, "rotation"},
      {"a translation with NaN", [](C c) { c.rig.right_from_left.translation().z() = kNoNumber; }, "baseline"},
      {"a transform whose last row is not that of a rigid one", [](C c) { c.rig.right_from_left.matrix()(3, 0) = 1; },
       "rotation"},
      {"a mask with a size and no pixels", [](C c) { c.rig.left_mask.width = 160, c.rig.left_mask.height = 100; },
       "a mask of 160 x 100 with 0 values"},
      {"a mask with pixels and no size", [](C c) { c.rig.right_mask.hidden.resize(16000); }, "a mask of 0 x 0"},
      {"an undistortion table without y", [](C c) { c.distort(), c.rig.left_undistortion.source_y.change().clear(); },
       "table of 160 x 100 with 0 values"},
      {"an undistortion table of negative size", [](C c) { c.distort(), c.rig.left_undistortion.width = -160; },
       "table of -160"},
      {"an undistortion table of recorded images of negative size",
       [](C c) { c.distort(), c.rig.left_undistortion.recorded_width = -1; }, "recorded images of -1"},
      {"an undistortion table with NaN",
       [](C c) {
         c.distort(), c.rig.right_undistortion.source_x.change()[7] = std::numeric_limits<float>::quiet_NaN();
       },
       "NaN"},
      {"a constant that is nearly zero", [](C c) { c.config.pose.disparity_offset_sigma = 1e-160; }, "1e-160",
       LibraryAttack::usage},
      {"cameras without pixels", [](C c) { c.rig.left.width = 0; }, ""},
      {"a constant out of range", [](C c) { c.config.stereo.ncc_min = 7; }, "ncc_min", LibraryAttack::usage},
      {"a constant of NaN", [](C c) { c.config.pose.inlier_distance = kNoNumber; }, "inlier_distance",
       LibraryAttack::usage},
      {"an unknown kernel variant", [](C c) { c.config.variants["scan"] = "abacus"; }, "abacus", LibraryAttack::usage},
      {"an unknown device", [](C) { Device{"abacus"}; }, "abacus", LibraryAttack::device},
      {"edges of an empty image", [](C c) { detect_edges({}, c.device, c.config); }, ""},
      {"a pair of different heights",
       [](C c) {
         match_stereo({0, c.frame.left, c.small.view()}, c.rig, c.device, c.config);
       },
       "80"},
      {"a missing recording", [](C) { open_dataset("/no/such/recording"); }, "no/such"},
      {"a missing calibration", [](C) { read_calibration("/no/such.yaml"); }, "no/such"},
      {"cameras of very different resolutions", [](C c) { c.rig.right.fx *= 20, c.rig.right.fy *= 20; },
       "a ratio of at most 16"},
      {"a ROS calibration without the image's height",
       [](C c) {
         auto [left, right] = calibration_files::ros_camera_infos({});
         left.erase(left.find("image_height"), std::string("image_height: 480\n").size());
         write_text(c.folder / "left.yaml", left);
         write_text(c.folder / "right.yaml", right);
         read_calibration(c.folder / "left.yaml," + c.folder / "right.yaml");
       },
       "left.yaml: found no entry image_height"},
      {"saved kernel variants that are a pipe",
       [](C c) {
         REQUIRE(mkfifo((c.folder / "variants.json").c_str(), 0600) == 0);
         bench::read_variants_file(c.folder / "variants.json", c.device.info());
       },
       "variants.json: found a pipe"},
      {"a missing trajectory", [](C) { read_trajectory("/no/such.txt"); }, "no/such"},
      {"trajectories at different times",
       [](C) {
         evaluate_trajectory({pose_at(0), pose_at(1)}, {pose_at(3'000'000'000), pose_at(4'000'000'000)});
       },
       ""},
      {"a trajectory with NaN in y",
       [](C) {
         Trajectory poses = {pose_at(0), pose_at(1)};
         poses[1].world_from_left.translation().y() = kNoNumber;
         evaluate_trajectory(poses, {pose_at(0), pose_at(1)});
       },
       "estimate: found pose 1"},
      {"a file without a name", [](C) { write_tum("", {}); }, "empty name"},
      {"a trajectory of one pose",
       [](C) {
         evaluate_trajectory({pose_at(0)}, {pose_at(0), pose_at(1)});
       },
       ""},
  };
  return attacks;
}

std::string message_of(const LibraryAttack& attack, Caller& caller) {
  try {
    attack.call(caller);
    caller.track();
  } catch (const DataError& error) {
    CHECK(attack.error == LibraryAttack::data);
    return error.what();
  } catch (const UsageError& error) {
    CHECK(attack.error == LibraryAttack::usage);
    return error.what();
  } catch (const DeviceError& error) {
    CHECK(attack.error == LibraryAttack::device);
    return error.what();
  }
  return "nothing was thrown: internal";
}

}  // namespace

TEST_CASE("attack: an invalid call throws an error that explains it") {
  CHECK_NOTHROW(Caller().track());
  for (const auto& attack : library_attacks()) {
    DYNAMIC_SECTION(attack.name) {
      Caller caller;
      CHECK_THAT(message_of(attack, caller), Contains(attack.words) && !Contains("internal"));
    }
  }
}
