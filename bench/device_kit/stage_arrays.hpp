#pragma once
/// \file stage_arrays.hpp  What every stage leaves of the first pair of a sequence, and its poses, as arrays that can
/// be stored and compared byte by byte.

#include <string>
#include <vector>

#include "device_kit/sequence.hpp"
#include "quadedge/device.hpp"
#include "quadedge/odometry.hpp"

namespace device_kit {

/// Values of one kind that a stage leaves.
struct StageArray {
  std::string stage, values;  ///< "stereo_mutual", "right x [px]"
  char type = 'f';            ///< f: float, d: double, i: 32-bit integer, b: byte
  std::string bytes;

  std::size_t size() const;
  double at(std::size_t i) const;
};

/// The stages in the order of a frame, with the constants of `config` and, where these leave SIFT out, with SIFT as
/// well. \throws quadedge::DeviceError
std::vector<StageArray> observe_arrays(const Sequence& sequence, quadedge::Device& device, const Config& config);

/// The tracked frames: status, counts and pose of each (world_from_left, 3 x 4).
std::vector<StageArray> pose_arrays(const std::vector<quadedge::FrameResult>& results);

/// How two arrays differ.
struct ArrayDifference {
  std::size_t values = 0;     ///< that the CPU has
  std::size_t found = 0;      ///< that this device has
  std::size_t differing = 0;  ///< of those that both have
  double largest = 0;         ///< infinite where the numbers of values differ, or only one value is a number

  bool is_equal() const { return differing == 0 && values == found; }
};
ArrayDifference difference(const StageArray& found, const StageArray& expected);

/// \throws std::runtime_error naming the file.
void write_arrays(const std::string& file, const std::vector<StageArray>& arrays);
std::vector<StageArray> read_arrays(const std::string& file);

}  // namespace device_kit
