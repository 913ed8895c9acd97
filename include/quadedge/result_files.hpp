#pragma once
/// \file result_files.hpp  The results folder of `quadedge run`, for frames that a program tracks by itself.

#include <memory>
#include <string>

#include "quadedge/odometry.hpp"

namespace quadedge {

/// Where the frames came from, for report.json.
struct ResultOrigin {
  std::string name;     ///< of the recording or camera
  std::string command;  ///< command line of the program
};

/// Writes config.toml at once, rows of trajectory.txt, trajectory_kitti.txt, frames.csv and poses.csv with every frame,
/// and report.json at the end. Keeps the results of all frames in memory for it. Not for several threads at a time.
class ResultFiles {
 public:
  /// `force`: replaces results in the folder. \throws UsageError for a folder that has results, and for one that
  /// another run writes to; DataError (naming the path) for one that cannot be made or written.
  ResultFiles(const std::string& folder, const StereoOdometry& odometry, const ResultOrigin& origin,
              bool force = false);
  ~ResultFiles();
  ResultFiles(ResultFiles&&) noexcept;

  /// \throws DataError (naming the path) when the files cannot be written.
  void add(const FrameResult& result);
  /// Writes report.json. `ended_early`: why, if not all frames were tracked. \throws as add().
  void finish(const std::string& ended_early = {});

 private:
  struct Open;
  std::unique_ptr<Open> open_;
};

}  // namespace quadedge
