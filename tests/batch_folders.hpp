#pragma once
/// \file batch_folders.hpp  A small batch for tests: a folder of rendered sequences.

#include <filesystem>
#include <string>

#include "program.hpp"

/// Rendered sequences a/first, a/second and broken (without calibration.txt), created once per process. Do not change
/// them.
inline const std::string& batch_root() {
  static const TemporaryFolder folder;
  static const std::string root = [] {
    for (const auto& [name, seed] : {std::pair<std::string, std::string>{"a/first", "1"}, {"a/second", "2"}}) {
      const std::string place = folder / ("root/" + name);
      const auto result =
          run_program({"synth", place, "--frames", "4", "--size", "240x150", "--seed", seed, "--quiet"});
      if (result.code != 0) throw std::runtime_error("synth failed: " + result.err);
    }
    std::filesystem::copy(folder / "root/a/first", folder / "root/broken", std::filesystem::copy_options::recursive);
    std::filesystem::remove(folder / "root/broken/calibration.txt");
    return folder / "root";
  }();
  return root;
}
