#pragma once
/// \file self_test_record.hpp  Stored data of the self-test: two small frames and the results of the reference.

#include <string>
#include <vector>

#include "frontend/stage_rows.hpp"

namespace quadedge::frontend {

/// Content of host/frontend/self_test.rows.
struct SelfTestRecord {
  SmallSequence sequence;
  std::vector<StageRows> stages;
};

/// Converts to text: the rig, the images in hexadecimal digits, the rows of every stage.
std::string to_text(const SelfTestRecord& record);

/// \throws std::runtime_error for a text that was not written by to_text()
SelfTestRecord parse_self_test(const std::string& text);

/// The text embedded by the build.
const std::string& stored_self_test();

}  // namespace quadedge::frontend
