#include "quadedge/self_test.hpp"

#include <future>

#include "frontend/stage_rows.hpp"
#include "opencl/context.hpp"
#include "stages/stage.hpp"

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

}  // namespace

SelfTestResult self_test(Device& device, const std::map<std::string, std::string>& variants) {
  constexpr double kAllowed = 0.02;  // fraction of the rows: different rounding changes decisions near a limit
  const KernelCheck kernels(device.context());
  if (device.context() != nullptr) {
    // Checked first, because the frames are small, so that no stage has long loops.
    const std::string difference = stages::long_loop_difference(*device.context());
    if (!difference.empty()) return {"long_loop", difference + kernels.text()};
  }
  const auto sequence = frontend::small_sequence();
  auto computed = std::async(std::launch::async, [&] {  // while the device's kernels are built
    Device reference("reference");
    return frontend::observe_stages(sequence, reference, {});
  });
  const auto found = frontend::observe_stages(sequence, device, variants);
  const auto expected = computed.get();
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const std::string difference = frontend::difference(found.at(i), expected[i], kAllowed);
    if (!difference.empty()) return {expected[i].stage, difference + kernels.text()};
  }
  return {};
}

}  // namespace quadedge
