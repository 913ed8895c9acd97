#pragma once
/// \file comparison.hpp  A batch beside another batch and beside other systems, for its page.

#include <string>
#include <vector>

namespace quadedge::report {

/// Version of the document; grows when a key changes its meaning.
constexpr int kComparisonSchema = 2;

/// Another system: FOLDER holds NAME.txt, or NAME/trajectory.txt, per sequence (TUM format, left camera).
struct Peer {
  std::string name, folder;
};

/// Text of a JSON document. `sequences` has an entry per sequence of the batch in `output`: the other batch's figures
/// (`baseline`: tracked frames, latency, accuracy), the other trajectories (`systems`: name, file, accuracy and the
/// errors of every pose against the ground truth of the batch), and `notes` on what could not be compared. `baseline`:
/// folder of the other batch, or empty.
/// \throws DataError if `output` or `baseline` is not a batch.
std::string comparison_json(const std::string& output, const std::string& baseline, const std::vector<Peer>& peers,
                            const std::string& command);

}  // namespace quadedge::report
