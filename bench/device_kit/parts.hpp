#pragma once
/// \file parts.hpp  The parts of device_check. Each one runs in a process of its own and adds rows to one file.

#include <string>
#include <vector>

#include "device_kit/rows.hpp"
#include "device_kit/sequence.hpp"
#include "quadedge/device.hpp"

namespace device_kit {

using quadedge::Device;

/// What every part takes.
struct Options {
  Rows rows;
  std::string device;                  ///< as quadedge::Device takes it
  std::string programs;                ///< folder of built programs; empty: none are kept
  std::string data;                    ///< folder of the sequences and presets
  std::vector<std::string> arguments;  ///< of the part

  Device open_device(bool profiling) const;
  Sequence sequence() const;                             ///< that the first argument names
  Config preset(const std::string& name) const;          ///< without a disparity range
  const std::string& argument(std::size_t index) const;  ///< \throws UsageError
};

void device_part(const Options& options);     ///< driver, floating point, limits
void self_test_part(const Options& options);  ///< cold | kept
void programs_part(const Options& options);   ///< build time of every program
void variants_part(const Options& options);   ///< SEQUENCE: every variant of every stage
void bench_part(const Options& options);      ///< SEQUENCE PRESET SECONDS: latency and shares
void compare_part(const Options& options);    ///< SEQUENCE: stages and poses against the stored ones
void record_part(const Options& options);     ///< SEQUENCE: stores what compare_part() compares with

}  // namespace device_kit
