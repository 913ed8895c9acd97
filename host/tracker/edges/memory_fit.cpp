/// \file memory_fit.cpp  Bytes per pixel and per edge give the number of edges that three quarters of the memory hold.
#include "edges/memory_fit.hpp"

#include <algorithm>

#include "common/layouts.hpp"
#include "quadedge/error.hpp"

namespace quadedge::frontend {
namespace {

/// What the images and the edges of a method need.
struct Bytes {
  double per_pixel, per_edge;
};
constexpr Bytes kDefault = {160, 5000}, kPaper = {320, 12000};
constexpr double kFixedBytes = 16e6;
constexpr double kUsable = 0.75;        // of the memory; the rest is left to the driver and other programs
constexpr double kEdgesPerPixel = 0.2;  // in densely textured images if all edges are used
constexpr int kFewest = 1000;           // minimum number of edges per image with which tracking is worthwhile
constexpr double kMegabyte = 1e6;

const Bytes& bytes_of(const Config& config) { return config.is_paper() ? kPaper : kDefault; }

double pixels(const StereoRig& rig) { return static_cast<double>(rig.left.width) * rig.left.height; }

std::string megabytes(double bytes) { return std::to_string(static_cast<long>(bytes / kMegabyte)) + " MB"; }

double bytes_without_edges(const StereoRig& rig, const Config& config) {
  return kFixedBytes + bytes_of(config).per_pixel * pixels(rig);
}

/// Memory left for edges [bytes].
double bytes_for_edges(const StereoRig& rig, const Config& config, std::size_t memory_bytes) {
  return kUsable * static_cast<double>(memory_bytes) - bytes_without_edges(rig, config);
}

double wanted_edges(const StereoRig& rig, const EdgesConfig& edges) {
  const double most = kDenseBudget * static_cast<float>(edges.budget);
  return std::min<double>(edges.max_edges, edges.budget == 0 ? kEdgesPerPixel * pixels(rig) : most);
}

}  // namespace

MemoryFit fit_memory(const StereoRig& rig, const Config& config, std::size_t memory_bytes) {
  MemoryFit fit{config, {}};
  const double room = bytes_for_edges(rig, config, memory_bytes) / bytes_of(config).per_edge;
  if (wanted_edges(rig, config.edges) <= room) return fit;
  if (room < kFewest) {
    throw DeviceError("the device memory of " + megabytes(static_cast<double>(memory_bytes)) + " is too small for " +
                      "images of " + std::to_string(rig.left.width) + "x" + std::to_string(rig.left.height) +
                      " px, which need about " + megabytes(bytes_without_edges(rig, config)) +
                      " without edges. Use another device or " + "smaller images");
  }
  const int budget = static_cast<int>(room);
  fit.config.edges.budget = budget;
  fit.config.edges.max_spacing = 1000;  // never more
  fit.config.edges.max_edges = std::min(config.edges.max_edges, config.is_paper() ? budget : 2 * budget);
  fit.message =
      "the device memory of " + megabytes(static_cast<double>(memory_bytes)) + " holds about " +
      std::to_string(budget) + " edges per image: " +
      (config.is_paper()
           ? "edges.max_edges (" + std::to_string(config.edges.max_edges)
           : "edges.budget (" + (config.edges.budget == 0 ? "all edges" : std::to_string(config.edges.budget))) +
      ") is reduced to that";
  return fit;
}

bool fits_beside(const StereoRig& rig, const Config& config, std::size_t bytes, std::size_t memory_bytes) {
  return bytes_of(config).per_edge * wanted_edges(rig, config.edges) + static_cast<double>(bytes) <=
         bytes_for_edges(rig, config, memory_bytes);
}

}  // namespace quadedge::frontend
