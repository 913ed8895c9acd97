#pragma once
/// \file loader_faults.hpp  Why the OpenCL loader finds no driver.

#include <string>

namespace quadedge::opencl {

/// Sentences about environment variables (OCL_ICD_VENDORS, OCL_ICD_FILENAMES) and .icd files that name what does not
/// exist or cannot be loaded; empty if there is none. For messages only: it loads the drivers.
std::string loader_faults();

}  // namespace quadedge::opencl
