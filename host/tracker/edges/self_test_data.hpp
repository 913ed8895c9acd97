#pragma once
/// \file self_test_data.hpp  Two frames and what the plain C++ reference finds in them: self_test.bin, which is part of
/// the library as the kernels are.

#include <string>
#include <utility>
#include <vector>

#include "edges/stage_rows.hpp"

namespace quadedge::frontend {

struct SelfTestData {
  SmallSequence sequence;
  std::vector<StageRows> expected;                    ///< of the default method, in the order of the stages
  std::vector<std::pair<std::string, double>> paper;  ///< constants of the paper's preset that are not the defaults
  std::vector<StageRows> paper_expected;              ///< of the paper's method with them

  Config paper_config() const;
};

/// The contents of self_test.bin.
const SelfTestData& self_test_data();

/// The bytes of such a file, little-endian. \throws std::out_of_range for a row whose numbers do not fit in 16 bits
std::string bytes_of(const SelfTestData& data);

}  // namespace quadedge::frontend
