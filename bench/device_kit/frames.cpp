/// \file frames.cpp  Writes the first frames of a sequence for the device kit, and the presets. Needs the whole
/// library: it decodes images and reads calibrations, which the kit's own programs cannot.
///   kit_frames presets FILE
///   kit_frames NAME FOLDER [PATH]     PATH: recorded sequence; without it the built-in room
#include <cstdio>
#include <exception>
#include <map>
#include <string>

#include "cli/frame_source.hpp"
#include "device_kit/sequence.hpp"
#include "quadedge/config_file.hpp"

namespace {

using namespace quadedge;

constexpr int kFrames = 12;

void write_frames(const std::string& name, const std::string& folder, cli::FrameSource& source) {
  device_kit::Sequence sequence;
  sequence.name = name;
  sequence.rig = source.rig();
  for (int i = 0; i < kFrames; ++i) {
    auto frame = source.next();
    if (!frame) break;
    sequence.frames.push_back(std::move(*frame));
  }
  device_kit::write_sequence(folder, sequence);
}

int write(const std::string& name, const std::string& target, const char* path) {
  if (name == "presets") {
    std::map<std::string, Config> presets;
    for (const auto& preset : preset_names()) presets[preset] = read_preset(preset);
    device_kit::write_presets(target, presets);
    return 0;
  }
  SyntheticOptions scene;
  scene.frames = kFrames;
  const auto source =
      path == nullptr ? cli::make_synthetic_source(scene) : cli::make_recorded_source(open_dataset(path));
  write_frames(name, target, *source);
  return 0;
}

}  // namespace

int main(int count, char** arguments) {
  if (count < 3 || count > 4) {
    std::fprintf(stderr, "usage: kit_frames presets FILE | kit_frames NAME FOLDER [PATH]\n");
    return 2;
  }
  try {
    return write(arguments[1], arguments[2], count > 3 ? arguments[3] : nullptr);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "kit_frames: %s\n", error.what());
    return 1;
  }
}
