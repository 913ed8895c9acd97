#pragma once
/// \file drawing.hpp  Pictures of results as PNG files, each with its legend. All functions \throw DataError when the
/// file cannot be written.

#include <string>

#include "quadedge/edges.hpp"
#include "quadedge/image.hpp"
#include "quadedge/odometry.hpp"

namespace quadedge::report {

/// Third-order edges as short strokes along their direction, coloured by direction, over the darkened image.
void draw_edges(const std::string& path, const ImageView& image, const EdgeSet& edges);

/// The left image with the stereo edges of its pair, coloured by disparity.
void draw_stereo(const std::string& path, const ImageView& left, const StereoEdges& edges);

/// The left image with its stereo edges coloured by disparity, and the motion of the left edges of quads since the
/// earlier frame: inliers white, others red, one per cell of 16 px.
void draw_quads(const std::string& path, const ImageView& left, const FrameDetails& details);

/// Both recorded images of a frame side by side, reduced to a width of 960 px, as JPEG.
void draw_pair(const std::string& path, const ImageView& left, const ImageView& right);

/// The picture of draw_quads without its legend, reduced to a width of 480 px, as JPEG.
void draw_quads_thumbnail(const std::string& path, const ImageView& left, const FrameDetails& details);

}  // namespace quadedge::report
