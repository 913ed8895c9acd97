#pragma once
/// \file long_loop.hpp  Whether a device runs loops to their end.

#include <string>

#include "opencl/context.hpp"

namespace quadedge::stages {

/// Runs one work-item through a million rounds, which takes milliseconds.
/// \returns what is wrong, in one sentence; empty where nothing is \throws DeviceError
std::string long_loop_difference(opencl::Context& context);

}  // namespace quadedge::stages
