#pragma once
/// \file variant_comparison.hpp  Every kernel variant of a stage on the same input.

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "benchmark/ceilings.hpp"
#include "benchmark/stage_work.hpp"
#include "quadedge/config.hpp"
#include "quadedge/dataset.hpp"
#include "quadedge/device.hpp"

namespace quadedge::bench {

/// What became of one variant.
struct VariantResult {
  std::string name;
  bool is_default = false;
  bool runs = true;      ///< false: the device refuses it; `why` says how
  bool agrees = false;   ///< with the reference on a small input, and with the default's bytes on the measured one
  std::string why;       ///< empty, or why there is no time
  double median_ms = 0;  ///< of the stage in one frame by OpenCL events; NaN without a time
  double p10_ms = 0, p90_ms = 0;
  double ratio_to_default = 0;  ///< median over the repetitions, each with the default's time beside it
  double ratio_p90 = 0;         ///< 90th percentile of the same: below 1 the variant wins beyond the noise
  double bandwidth_share = 0,
         arithmetic_share = 0;  ///< of the device's ceilings, for the least work; NaN without a time
};

/// All variants of one stage.
struct StageResult {
  std::string stage;
  std::vector<VariantResult> variants;
  /// The fastest one that agrees; the default unless another is at least 3 % faster, and faster in nine of ten
  /// repetitions. Empty where the input never runs the stage.
  std::string best() const;
};

/// What is compared on.
struct VariantInput {
  const StereoRig& rig;
  const FramePrefetcher::Frame& first;
  const FramePrefetcher::Frame& second;
  Config config;                        ///< complete; its variants are those that all other stages run with
  std::function<Device()> open_device;  ///< with profiling
  int repetitions = 9;
  FrameSize size;  ///< of the second frame, see count_frame()
};

/// A small input and what the plain C++ reference makes of it; serves all stages.
class ReferenceCheck {
 public:
  /// `config`: the method's constants; the search range becomes that of the small input.
  explicit ReferenceCheck(const Config& config);
  ~ReferenceCheck();
  ReferenceCheck(const ReferenceCheck&) = delete;
  ReferenceCheck& operator=(const ReferenceCheck&) = delete;
  /// Why the device with these variants sees something else; empty when it agrees. \throws DeviceError.
  std::string difference(Device& device, const std::map<std::string, std::string>& variants) const;

 private:
  struct Small;
  std::unique_ptr<Small> small_;
};

/// Checks, then measures in turn, all variants of a stage. `progress` gets the name of what is going on.
/// \throws DeviceError when the default itself does not run.
StageResult compare_variants(const std::string& stage, const VariantInput& input, const ReferenceCheck& check,
                             const Ceilings& ceilings, const std::function<void(const std::string&)>& progress);

/// Names of all stages with variants, in order.
std::vector<std::string> stages_with_variants();

/// The results as JSON (doc/design.md section 10).
std::string comparison_json(const DeviceInfo& device, const Ceilings& ceilings, const std::vector<StageResult>& stages,
                            const std::string& command);

}  // namespace quadedge::bench
