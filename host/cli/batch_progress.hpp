#pragma once
/// \file batch_progress.hpp  How far a batch is: sequence, frame, rate, remaining time.

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "cli/console.hpp"

namespace quadedge::cli {

/// Counts the finished frames of a running sequence by the rows of its trajectory_kitti.txt, which gets one per frame.
class FrameCounter {
 public:
  explicit FrameCounter(std::string folder) : file_(std::move(folder) + "/trajectory_kitti.txt") {}
  /// Frames finished by now.
  int frames();

 private:
  std::string file_;
  std::int64_t read_ = 0;  ///< bytes
  int frames_ = 0;
};

/// The status line of a batch.
class BatchProgress {
 public:
  /// One running sequence.
  struct Running {
    std::string name;
    int done = 0, frames = 0;
  };

  /// `sequences`, `pixels`: of all that has to be run now; `already`: sequences that were finished before.
  BatchProgress(bool quiet, int sequences, int already, double pixels);
  /// A sequence has ended; `sentence` describes how.
  void finished(const std::string& name, int frames, double pixels, const std::string& sentence);
  /// `pixels`: of the finished frames of all running sequences.
  void update(const std::vector<Running>& running, double pixels);
  bool due() const { return status_.due(); }

 private:
  StatusLine status_;
  std::chrono::steady_clock::time_point start_;
  int sequences_, already_, over_ = 0, frames_ = 0;
  double pixels_, pixels_over_ = 0;
};

}  // namespace quadedge::cli
