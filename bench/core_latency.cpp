/// \file core_latency.cpp  Latency per frame on the built-in sequence with nothing but quadedge_core: for a machine
/// that has an OpenCL device and little else. Prints JSON; `quadedge bench` measures more where the whole program can
/// run.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <map>
#include <string>
#include <vector>

#include "quadedge/error.hpp"
#include "quadedge/odometry.hpp"
#include "quadedge/synthetic.hpp"

namespace {

using namespace quadedge;
using Clock = std::chrono::steady_clock;

constexpr const char* kUsage =
    "usage: core_latency [--device D] [--frames N] [--warm-up N] [--scene room|cables|facade]\n"
    "                    [--path ellipse|handheld|drive|loop] [--size WxH] [--threshold T]\n"
    "  --device     auto, cpu, gpu, a number or a part of the name; default auto\n"
    "  --frames     frames measured, default 30; --warm-up: frames between the first one and them, default 5\n"
    "  --size       px, default 942x489\n"
    "  --threshold  edges.threshold, default 6: about 50,000 edges per image of the room\n";

struct Settings {
  std::string device = "auto";
  int frames = 30, warm_up = 5;
  SyntheticOptions scene;
  double threshold = 6;
};

/// \throws UsageError for what it does not know.
Settings parse(int count, char** values) {
  Settings settings;
  for (int i = 1; i < count; i += 2) {
    const std::string name = values[i];
    if (i + 1 >= count) throw UsageError(name + ": a value is missing");
    const std::string value = values[i + 1];
    if (name == "--device")
      settings.device = value;
    else if (name == "--frames")
      settings.frames = std::atoi(value.c_str());
    else if (name == "--warm-up")
      settings.warm_up = std::atoi(value.c_str());
    else if (name == "--scene")
      settings.scene.scene = value;
    else if (name == "--path")
      settings.scene.path = value;
    else if (name == "--threshold")
      settings.threshold = std::atof(value.c_str());
    else if (name == "--size") {
      if (std::sscanf(value.c_str(), "%dx%d", &settings.scene.width, &settings.scene.height) != 2)
        throw UsageError("--size " + value + ": expected WxH");
      settings.scene.focal = 0.575 * settings.scene.width;
    } else
      throw UsageError("unknown option " + name);
  }
  if (settings.frames < 1 || settings.warm_up < 0)
    throw UsageError("--frames: expected 1 or more, --warm-up: 0 or more");
  settings.scene.frames = 1 + settings.warm_up + settings.frames;
  return settings;
}

/// Value below which `share` of the sorted values lie.
double quantile(const std::vector<double>& sorted, double share) {
  return sorted[std::min(sorted.size() - 1, static_cast<std::size_t>(share * static_cast<double>(sorted.size())))];
}

void print_latency(const char* name, std::vector<double> values) {
  std::sort(values.begin(), values.end());
  std::printf("  \"%s\": {\"median\": %.3f, \"p90\": %.3f, \"p99\": %.3f, \"max\": %.3f},\n", name,
              quantile(values, 0.5), quantile(values, 0.9), quantile(values, 0.99), values.back());
}

struct Frames {
  std::vector<RenderedView> left, right;
};

Frames render(const SyntheticSequence& sequence) {
  Frames frames;
  for (int i = 0; i < sequence.frames(); ++i) {
    frames.left.push_back(sequence.render(i, Side::left));
    frames.right.push_back(sequence.render(i, Side::right));
    std::fprintf(stderr, "\rrendering %d / %d", i + 1, sequence.frames());
  }
  std::fprintf(stderr, "\n");
  return frames;
}

/// Tracks all frames; returns the first one and those after the warm-up.
std::vector<FrameResult> track(const Settings& settings, const SyntheticSequence& sequence, const Frames& frames,
                               StereoOdometry& odometry) {
  std::vector<FrameResult> results;
  for (int i = 0; i < sequence.frames(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    auto result = odometry.track({sequence.stamp_ns(i), frames.left[k].image.view(), frames.right[k].image.view()});
    if (i == 0 || i > settings.warm_up) results.push_back(std::move(result));
  }
  return results;
}

int measure(const Settings& settings) {
  const SyntheticSequence sequence(settings.scene);
  const Frames frames = render(sequence);
  Config config;
  config.edges.threshold = settings.threshold;
  config.stereo.max_disparity = sequence.max_disparity();

  const auto start = Clock::now();
  Device device(settings.device);
  StereoOdometry odometry(sequence.rig(), device, config);
  const double start_ms = std::chrono::duration<double, std::milli>(Clock::now() - start).count();
  const auto results = track(settings, sequence, frames, odometry);
  const FrameResult& last = results.back();
  const double error =
      (last.world_from_left.translation() - sequence.world_from_left(sequence.frames() - 1).translation()).norm();
  std::vector<double> latency;
  int tracked = 0;
  for (std::size_t i = 1; i < results.size(); ++i) {
    latency.push_back(results[i].latency_ms);
    tracked += results[i].status == FrameStatus::tracked ? 1 : 0;
  }

  DeviceOptions profiling;
  profiling.profiling = true;
  Device profiled_device(settings.device, profiling);
  StereoOdometry profiled(sequence.rig(), profiled_device, config);
  std::map<std::string, std::vector<double>> kernels;
  const auto profiled_results = track(settings, sequence, frames, profiled);
  for (std::size_t i = 1; i < profiled_results.size(); ++i)
    for (const auto& stage : profiled_results[i].stages)
      if (stage.stage.rfind("device ", 0) == 0) kernels[stage.stage.substr(7)].push_back(stage.ms);

  std::printf(
      "{\n  \"device\": \"%s\",\n  \"driver\": \"%s\",\n  \"size\": [%d, %d],\n  \"frames\": %d, \"tracked\": %d,\n",
      device.info().name.c_str(), device.info().driver.c_str(), settings.scene.width, settings.scene.height,
      settings.frames, tracked);
  std::printf("  \"edges\": [%d, %d], \"stereo_edges\": %d, \"quads\": %d,\n", last.counts.edges_left,
              last.counts.edges_right, last.counts.stereo_edges, last.counts.quads);
  std::printf("  \"start_ms\": %.1f, \"kernel_build_ms\": %.1f, \"first_frame_ms\": %.3f,\n", start_ms,
              odometry.kernel_build_ms(), results.front().latency_ms);
  print_latency("latency_ms", latency);
  for (auto& [stage, times] : kernels) print_latency(("kernels " + stage + " ms").c_str(), times);
  std::printf("  \"device_mb\": %.1f,\n  \"end_error_m\": %.6f\n}\n",
              static_cast<double>(odometry.device_bytes()) / 1048576, error);
  return tracked == settings.frames ? 0 : 1;
}

}  // namespace

int main(int count, char** values) {
  try {
    return measure(parse(count, values));
  } catch (const UsageError& error) {
    std::fprintf(stderr, "%s\n%s", error.what(), kUsage);
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
