#pragma once
/// \file self_test_record.hpp  The stored side of the self-test: two small frames and what the reference makes of them.

#include <string>
#include <vector>

#include "frontend/stage_rows.hpp"

namespace quadedge::frontend {

/// What host/frontend/self_test.rows holds.
struct SelfTestRecord {
  SmallSequence sequence;
  std::vector<StageRows> stages;
};

/// As text: the rig, the images in hexadecimal digits, the rows of every stage.
std::string to_text(const SelfTestRecord& record);

/// \throws std::runtime_error for a text that to_text() did not write.
SelfTestRecord parse_self_test(const std::string& text);

/// The text that the build embeds.
const std::string& stored_self_test();

}  // namespace quadedge::frontend
