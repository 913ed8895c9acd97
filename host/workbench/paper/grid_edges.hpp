#pragma once
/// \file grid_edges.hpp  Third-order edges as published: two samples per pixel and axis, direction at the cell that
/// won, position and strength at the peak of the parabola. After the code of the paper's reference [8]; the paper
/// prints no constant of it. Plain C++ twin of kernels/grid_edges.cl.

#include "quadedge/config.hpp"
#include "quadedge/image.hpp"
#include "reference/edge_detection.hpp"

namespace quadedge::paper {

/// Edges whose gradient exceeds `threshold` [grey levels per px], at least `config.margin` px inside an image of any
/// size. They are sorted by the pixel that they lie in, row by row, and then by x; there may be up to four in a pixel.
/// Not set: scale_shift, which is 0. \throws UsageError for an empty image
reference::ReferenceEdges grid_edges(const ImageView& image, const EdgesConfig& config, double threshold);

}  // namespace quadedge::paper
