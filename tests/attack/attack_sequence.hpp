#pragma once
/// \file attack_sequence.hpp  Sequences for attacks: rendered or recorded frames in memory, and alterations of them.

#include <functional>
#include <string>
#include <vector>

#include "quadedge/camera.hpp"
#include "quadedge/config.hpp"
#include "quadedge/image.hpp"

namespace attack {

/// A sequence with its true poses and the calibration that the odometry gets.
struct Sequence {
  quadedge::StereoRig rig;
  quadedge::Config config;
  std::vector<quadedge::Image> left, right;
  std::vector<Eigen::Isometry3d> world_from_left;

  std::size_t size() const { return left.size(); }
  quadedge::StereoFrame frame(std::size_t i) const {
    return {static_cast<std::int64_t>(i) * 50'000'000, left[i].view(), right[i].view()};
  }
};

/// A change to a sequence.
using Alteration = std::function<void(Sequence&)>;

/// Frames of a built-in scene, 480 x 249 px, every `step`-th; rendered once per process.
const Sequence& rendered(const std::string& scene, int frames, int step = 1, double blur = 0, double light = 1,
                         double noise = 1.5);

/// The first frames of a recording below the folder QUADEDGE_DATA; empty if there is none.
const Sequence& recorded(const std::string& path, int frames);

/// An image whose pixel (x, y) is that of `image` at from(x, y), bilinear; black outside.
quadedge::Image warp(const quadedge::Image& image, int width, int height,
                     const std::function<Eigen::Vector2d(double, double)>& from);

/// A board that moves in front of the camera.
struct Board {
  double area = 0.3;         ///< fraction of the left image that it covers, halfway along its path
  double speed = 4;          ///< [px per frame]
  double disparity = 11;     ///< nearer than the scene [px]
  bool fine = false;         ///< texture: a mosaic of squares instead of blobs
  std::size_t begin = 0;     ///< frame in which it appears
  bool still_camera = true;  ///< all frames show the scene of the first one, each with new camera noise
};
void add_board(Sequence& sequence, const Board& board);

/// Every image shows a checkerboard across the whole view, which the camera passes sideways by `speed` px per frame.
/// \param cell side of a square [px] \param disparity [px]
void show_checkerboard(Sequence& sequence, double cell, double speed, double disparity);

}  // namespace attack
