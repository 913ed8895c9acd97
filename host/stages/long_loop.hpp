#pragma once
/// \file long_loop.hpp  Whether a device runs loops to their end.

#include <string>

#include "opencl/context.hpp"

namespace quadedge::stages {

/// Longer than the limits that drivers are known to set, and over in milliseconds.
constexpr cl_int kLongLoop = 1'000'000;

/// Runs one work-item through so many rounds.
/// \returns what is wrong, in one sentence; empty where nothing is \throws DeviceError
std::string long_loop_difference(opencl::Context& context, cl_int rounds = kLongLoop);

}  // namespace quadedge::stages
