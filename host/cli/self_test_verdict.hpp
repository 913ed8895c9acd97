#pragma once
/// \file self_test_verdict.hpp  Verdicts of the self-test, kept for every device, driver and program.

#include <map>
#include <optional>
#include <string>

#include "quadedge/device.hpp"
#include "quadedge/self_test.hpp"

namespace quadedge::cli {

/// What was found when this program tested the device with these variants, with this driver; nothing where it has not
/// been, or where the file is damaged or cannot be read.
std::optional<SelfTestResult> kept_verdict(const DeviceInfo& device,
                                           const std::map<std::string, std::string>& variants);

/// Keeps a verdict in $XDG_CACHE_HOME/quadedge/self_tests (~/.cache without it). Where that cannot be written, the next
/// start tests again.
void keep_verdict(const DeviceInfo& device, const std::map<std::string, std::string>& variants,
                  const SelfTestResult& result);

}  // namespace quadedge::cli
