#pragma once
/// \file testing.hpp  What most tests need: Catch2, the standard library, Eigen, the public headers, devices and
/// temporary files. Precompiled.

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <limits>
#include <map>
#include <memory>
#include <numeric>
#include <optional>
#include <random>
#include <regex>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <sys/stat.h>
#include <sys/wait.h>
#include <thread>
#include <tuple>
#include <unistd.h>
#include <utility>
#include <variant>
#include <vector>

#include "devices.hpp"
#include "quadedge/calibration.hpp"
#include "quadedge/camera.hpp"
#include "quadedge/config.hpp"
#include "quadedge/dataset.hpp"
#include "quadedge/detect_edges.hpp"
#include "quadedge/device.hpp"
#include "quadedge/drive_calibration.hpp"
#include "quadedge/edges.hpp"
#include "quadedge/error.hpp"
#include "quadedge/evaluation.hpp"
#include "quadedge/filters.hpp"
#include "quadedge/image.hpp"
#include "quadedge/localiser.hpp"
#include "quadedge/map.hpp"
#include "quadedge/match_stereo.hpp"
#include "quadedge/odometry.hpp"
#include "quadedge/pair_stream.hpp"
#include "quadedge/point_cloud.hpp"
#include "quadedge/poses.hpp"
#include "quadedge/result_files.hpp"
#include "quadedge/rig_estimate.hpp"
#include "quadedge/rig_evidence.hpp"
#include "quadedge/self_test.hpp"
#include "quadedge/stereo_source.hpp"
#include "quadedge/synthetic.hpp"
#include "quadedge/tap.hpp"
#include "quadedge/threads.hpp"
#include "quadedge/trajectory.hpp"
#include "temporary_folder.hpp"
#include "text_files.hpp"

/// The message of the error that a call throws; empty if it throws none.
inline std::string message_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const quadedge::Error& error) {
    return error.what();
  }
  return "";
}

/// Options of rendered images of this size.
inline quadedge::SyntheticOptions rendering(int width, int height, double focal, int frames, int supersampling) {
  quadedge::SyntheticOptions options;
  options.width = width;
  options.height = height;
  options.focal = focal;
  options.frames = frames;
  options.supersampling = supersampling;
  return options;
}
