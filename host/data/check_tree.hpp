#pragma once
/// \file check_tree.hpp  Lists the recordings and pairs in a folder.

#include <string>
#include <vector>

#include "quadedge/dataset.hpp"

namespace quadedge::data {

/// A recording or pair of a tree.
struct TreeMember {
  std::string path;    ///< relative to the tree
  std::string format;  ///< layout
};

/// Recordings and still pairs in and below a folder, sorted by path. A folder that is one itself yields one member with
/// the path ".".
std::vector<TreeMember> find_members(const std::string& root);

/// One line about a checked member: layout, number of frames, size, ground truth, number of warnings.
std::string one_line(const DatasetCheck& check);

}  // namespace quadedge::data
