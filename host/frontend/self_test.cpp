#include "quadedge/self_test.hpp"

#include "frontend/self_test_record.hpp"
#include "stages/long_loop.hpp"

namespace quadedge {

SelfTestResult self_test(Device& device, const std::map<std::string, std::string>& variants) {
  constexpr double kAllowed = 0.02;  // fraction of the rows: different rounding changes decisions near a limit
  if (device.context() != nullptr) {
    // Checked first, because the recorded frames are small, so that no stage has long loops.
    const std::string difference = stages::long_loop_difference(*device.context());
    if (!difference.empty()) return {"long_loop", difference};
  }
  const frontend::SelfTestRecord stored = frontend::parse_self_test(frontend::stored_self_test());
  const auto found = frontend::observe_stages(stored.sequence, device, variants);
  for (std::size_t i = 0; i < stored.stages.size(); ++i) {
    const std::string difference = frontend::difference(found.at(i), stored.stages[i], kAllowed);
    if (!difference.empty()) return {stored.stages[i].stage, difference};
  }
  return {};
}

}  // namespace quadedge
