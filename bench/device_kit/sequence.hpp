#pragma once
/// \file sequence.hpp  A short sequence in a folder that a program without OpenCV can read: images as PGM, the rig with
/// its tables, and the configurations of the presets.

#include <map>
#include <string>
#include <vector>

#include "quadedge/camera.hpp"
#include "quadedge/config.hpp"
#include "quadedge/dataset.hpp"

namespace device_kit {

using quadedge::Config;
using quadedge::StereoRig;
using Frame = quadedge::FramePrefetcher::Frame;

struct Sequence {
  std::string name;
  StereoRig rig;
  std::vector<Frame> frames;
};

/// Images of 8 bits only. \throws std::runtime_error naming the file.
void write_sequence(const std::string& folder, const Sequence& sequence);
Sequence read_sequence(const std::string& folder);

/// A line per preset: its name, then KEY=VALUE for every constant that differs from the defaults.
void write_presets(const std::string& file, const std::map<std::string, Config>& presets);
std::map<std::string, Config> read_presets(const std::string& file);

}  // namespace device_kit
