#pragma once
/// \file self_test.hpp  Whether a device computes what it should, asked before its first pose.

#include <map>
#include <string>

#include "quadedge/device.hpp"

namespace quadedge {

/// What became of the self-test.
struct SelfTestResult {
  std::string stage;       ///< the first stage whose results are wrong; empty: none is
  std::string difference;  ///< one sentence: how many of its results agree, and the first one that does not
  bool passed() const { return stage.empty(); }
};

/// Runs every stage on a small built-in pair of frames, with a search of each kind, and compares what each leaves with
/// stored results of the plain C++ reference; before that a long loop (`long_loop`), which some drivers cut short.
/// Takes tens of milliseconds once the kernels are built.
/// \param variants  stage -> kernel variant, as in Config
/// \throws DeviceError when a kernel does not build or run
SelfTestResult self_test(Device& device, const std::map<std::string, std::string>& variants = {});

}  // namespace quadedge
