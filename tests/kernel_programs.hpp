#pragma once
/// \file kernel_programs.hpp  Programs that tests write around the kernels' own functions.

#include <CL/opencl.hpp>

#include "device/kernel_sources.hpp"
#include "testing.hpp"

/// Builds `source` behind common.cl, layouts.cl and `files`.
inline cl::Program build_program(quadedge::opencl::Context& context, const std::vector<std::string>& files,
                                 const std::string& source) {
  const auto& kernels = quadedge::opencl::embedded_kernels();
  std::string text = kernels.at("common.cl") + "\n" + kernels.at("layouts.cl") + "\n";
  for (const auto& file : files) text += kernels.at(file) + "\n";
  cl::Program program(context.context(), text + source);
  program.build({context.device()}, context.build_options().c_str());
  return program;
}
