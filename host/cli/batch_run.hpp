#pragma once
/// \file batch_run.hpp  Runs the sequences of a batch, each in its own process and folder.

#include <string>
#include <vector>

#include "cli/batch_plan.hpp"
#include "cli/interruption.hpp"

namespace quadedge::cli {

/// Runs every member that is not finished, `options.jobs` (at least 1) at a time. Each one writes to
/// OUT/unfinished/NAME, which becomes OUT/sequences/NAME in one step when it is over, with a member.json that says how
/// it ended; so a result is there as a whole or not at all. A failing sequence does not stop the others. Ends early
/// when a signal came: the children are ended and what they had begun is removed. Returns how many members it has
/// finished, with whichever end. \throws DataError when OUT cannot be written (full disk); children end then, too.
int run_batch(const std::vector<BatchMember>& plan, const MethodOptions& method, const BatchOptions& options,
              const Interruption& interruption);

}  // namespace quadedge::cli
