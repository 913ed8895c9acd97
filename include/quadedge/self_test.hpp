#pragma once
/// \file self_test.hpp  Checks that a device computes correct results before it is used.

#include <map>
#include <string>

#include "quadedge/config.hpp"
#include "quadedge/device.hpp"

namespace quadedge {

/// Result of the self-test.
struct SelfTestResult {
  std::string stage;       ///< first stage with wrong results; empty: all stages are correct
  std::string difference;  ///< one sentence: how many results agree, and the first that does not
  bool passed() const { return stage.empty(); }
};

/// Runs every stage on two small frames, with each kind of search, and compares the results within a tolerance with
/// those of the C++ reference, which the library holds. A long loop (`long_loop`) is run first, because some drivers
/// terminate long loops early. Kernel arguments whose types differ from those that the host passes are listed in
/// `difference` if the results are wrong; if the results are right, the test passes. Takes tens of milliseconds once
/// the kernels are built. \param variants  stage -> kernel variant, as in Config \throws DeviceError if a kernel does
/// not build or run
SelfTestResult self_test(Device& device, const std::map<std::string, std::string>& variants = {});
/// The same for the method and the variants of `config`; the values are those of the method's preset.
SelfTestResult self_test(Device& device, const Config& config);

}  // namespace quadedge
