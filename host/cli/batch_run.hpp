#pragma once
/// \file batch_run.hpp  Runs the sequences of a batch, each in its own process and folder, and tells how far it is.

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "cli/batch_plan.hpp"
#include "cli/console.hpp"
#include "cli/interruption.hpp"

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

/// Runs every member that is not finished, `options.jobs` (at least 1) at a time. Each one writes to
/// OUT/unfinished/NAME, which becomes OUT/sequences/NAME in one step when it is over, with a member.json that says how
/// it ended; so a result is there as a whole or not at all. A failing sequence does not stop the others. Ends early
/// when a signal came: the children are ended and what they had begun is removed. Returns how many members it has
/// finished, with whichever end. \throws DataError when OUT cannot be written (full disk); children end then, too.
int run_batch(const std::vector<BatchMember>& plan, const MethodOptions& method, const BatchOptions& options,
              const Interruption& interruption);

}  // namespace quadedge::cli
