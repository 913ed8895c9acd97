#pragma once
/// \file kernel_sources.hpp  The kernel sources embedded by the build.

#include <map>
#include <string>

namespace quadedge::opencl {

/// File name ("edge_detection.cl") -> text, beginning with a #line marker.
const std::map<std::string, std::string>& embedded_kernels();

}  // namespace quadedge::opencl
