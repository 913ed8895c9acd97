#pragma once
/// \file batch_plan.hpp  What a batch has to do: its sequences, and which of them are done already.

#include <string>
#include <vector>

#include "cli/method_options.hpp"
#include "data/find_sequences.hpp"
#include "quadedge/device.hpp"

namespace quadedge::cli {

/// How to run a batch.
struct BatchOptions {
  std::string output;   ///< folder
  int jobs = 0;         ///< sequences at the same time; 0: what suits the device
  bool timing = false;  ///< latencies count: one sequence at a time, and no result that ran beside others
  bool force = false, quiet = false, profile = false, loops = false;
  int draw_every = 0;       ///< as SequenceRunOptions
  int thumbnails = 4;       ///< as SequenceRunOptions; the report shows them
  double min_tracked = 50;  ///< fewer tracked frames count as too few [percent]
};

/// One sequence of a batch.
struct BatchMember {
  data::FoundSequence sequence;
  int frames = 0;     ///< 0 where the recording cannot be opened
  double pixels = 0;  ///< of all left images together; the measure of how long a run takes
  std::string key;    ///< fingerprint of everything that decides the result; empty where the recording cannot be opened
  bool finished = false;  ///< OUT holds its result, made with the same key
};

/// Opens all recordings, as far as possible, and looks which results are there. `device`: that the runs will use.
/// \throws DataError when the results so far cannot be read.
std::vector<BatchMember> plan_batch(const std::vector<data::FoundSequence>& sequences, const MethodOptions& method,
                                    const DeviceInfo& device, const BatchOptions& options);

/// Sequences at the same time where the user leaves it open: as many as do not disturb one another. An OpenCL device
/// carries one (a CPU gives it all cores, and on a GPU the kernels of others delay it), the plain C++ reference one per
/// core. One with --timing or
/// --profile.
int default_jobs(const DeviceInfo& device, const BatchOptions& options);

}  // namespace quadedge::cli
