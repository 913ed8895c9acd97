#pragma once
/// \file device_model.hpp  A GPU by its figures, for estimates where none can be run on.

#include <string>

namespace quadedge::bench {

/// The keys of a file of config/devices. Nominal figures are those of a data sheet; of each, a share is taken to be
/// attainable.
struct DeviceModel {
  std::string file;         ///< that it was read from
  std::string name;         ///< of the GPU
  std::string source;       ///< of the nominal figures
  std::string assumptions;  ///< where the shares and the costs come from, which no data sheet tells
  double memory_gb_s = 0, memory_attainable = 0;             ///< bandwidth of the device's memory, 1e9 bytes per second
  double arithmetic_gflop_s = 0, arithmetic_attainable = 0;  ///< single precision, 1e9 operations per second
  double transfer_gb_s = 0, transfer_attainable = 0;         ///< between host and device, one way
  double launch_us = 0;  ///< that a kernel or a copy to the device takes to start after the one before
  double wait_us = 0;    ///< from the device's last result to the host's next command: a round trip
  double goal_ms = 0;    ///< of a frame on this GPU; 0: none
};

/// Reads a model. \throws DataError, naming file and key and what was expected.
DeviceModel read_device_model(const std::string& file);

}  // namespace quadedge::bench
