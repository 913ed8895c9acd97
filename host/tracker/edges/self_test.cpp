/// \file self_test.cpp  Runs every stage on the stored frames and compares its rows with the stored ones.
#include "quadedge/self_test.hpp"

#include <functional>
#include <vector>

#include "device/context.hpp"
#include "device/stage.hpp"
#include "edges/self_test_data.hpp"

namespace quadedge {
namespace {

/// Compares kernels with their host signatures while it exists.
class KernelCheck {
 public:
  explicit KernelCheck(opencl::Context* context) : context_(context) {
    if (context_ != nullptr) context_->check_kernels(true);
  }
  ~KernelCheck() {
    if (context_ != nullptr) context_->check_kernels(false);
  }
  KernelCheck(const KernelCheck&) = delete;
  KernelCheck& operator=(const KernelCheck&) = delete;

  /// The faults found so far, to follow a sentence.
  std::string text() const {
    std::string text;
    if (context_ == nullptr) return text;
    for (const auto& fault : context_->kernel_faults()) text += "; " + fault;
    return text;
  }

 private:
  opencl::Context* context_;
};

using Rows = std::vector<frontend::StageRows>;

/// \param observe the stages on a device
SelfTestResult compare_stages(Device& device, const Rows& expected, const std::function<Rows()>& observe) {
  constexpr double kAllowed = 0.02;  // fraction of the rows: different rounding changes decisions near a limit
  const auto use = device.use();
  const KernelCheck kernels(device.context());
  if (device.context() != nullptr) {
    // Checked first, because the frames are small, so that no stage has long loops.
    const std::string difference = stages::long_loop_difference(*device.context());
    if (!difference.empty()) return {"long_loop", difference + kernels.text()};
  }
  const Rows found = observe();
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const std::string difference = frontend::difference(found.at(i), expected[i], kAllowed);
    if (!difference.empty()) return {expected[i].stage, difference + kernels.text()};
  }
  return {};
}

}  // namespace

SelfTestResult self_test(Device& device, const std::map<std::string, std::string>& variants) {
  const frontend::SelfTestData& data = frontend::self_test_data();
  return compare_stages(device, data.expected,
                        [&] { return frontend::observe_stages(data.sequence, device, variants); });
}

SelfTestResult self_test(Device& device, const Config& config) {
  if (!config.is_paper()) return self_test(device, config.variants);
  const frontend::SelfTestData& data = frontend::self_test_data();
  Config paper = data.paper_config();
  paper.variants = config.variants;
  return compare_stages(device, data.paper_expected,
                        [&] { return frontend::observe_paper_stages(data.sequence, device, paper); });
}

}  // namespace quadedge
