#pragma once
/// \file long_loop.hpp  Whether a device runs loops to their end.

#include <string>

#include "opencl/context.hpp"

namespace quadedge::stages {

/// Longer than the limits of known drivers; takes milliseconds.
constexpr cl_int kLongLoop = 1'000'000;

/// Runs a loop of `rounds` iterations in one work-item.
/// \returns one sentence on what is wrong; empty if the loop reaches its end \throws DeviceError
std::string long_loop_difference(opencl::Context& context, cl_int rounds = kLongLoop);

}  // namespace quadedge::stages
