#pragma once
/// \file rig_file.hpp  What runs have learned of a stereo rig, kept for the next one: `run --rig-file`.

#include <map>
#include <string>
#include <vector>

#include "quadedge/camera.hpp"
#include "quadedge/config.hpp"
#include "quadedge/odometry.hpp"
#include "rig/row_model.hpp"

namespace quadedge::cli {

/// The disparity offset and the rows of a rig, in a file.
class RigFile {
 public:
  /// Reads the file if it exists. \param name empty: there is none
  /// \throws DataError for another kind of file, or for the file of another calibration
  RigFile(const std::string& name, const StereoRig& rig);

  /// The configuration with the offset of the file. \throws DataError for one that is out of range
  Config with_offset(const Config& config) const;
  /// Begins with the rows of the file.
  void start(const StereoOdometry& odometry) const;
  /// Takes over what is known after a frame.
  void learn(const StereoOdometry& odometry, const FrameResult& result);
  /// \throws DataError if the file cannot be written
  void write() const;

 private:
  std::string name_;
  std::map<std::string, std::vector<double>> cameras_;  ///< by which the file is known
  std::string offset_;                                  ///< two lines of configuration, or none
  rig::RowModel::Sums sums_;
};

}  // namespace quadedge::cli
