#pragma once
/// \file edge_selection.hpp  Plain C++ twin of kernels/edge_selection.cl. doc/method.md section 1.

#include <cstdint>
#include <vector>

#include "common/layouts.hpp"
#include "reference/edge_detection.hpp"

namespace quadedge::reference {

/// Maxima of the gradient of one image.
struct GradientMaxima {
  std::vector<float> x, y;                    ///< px
  std::vector<float> gradient_x, gradient_y;  ///< of any length
  std::vector<std::int32_t> row;              ///< of the pixel
};
GradientMaxima maxima_of(const ReferenceEdges& edges);

/// Distance of the lattice's lines at which the image with more edges has about `budget` of them [px]; 0: all maxima of
/// both images are kept.
float selection_spacing(const SelectionArguments& left_arguments, const GradientMaxima& left,
                        const SelectionArguments& right_arguments, const GradientMaxima& right, int budget);

/// Which maxima of an image become edges, one flag each.
std::vector<std::uint8_t> kept_by_selection(const SelectionArguments& arguments, const GradientMaxima& maxima,
                                            float spacing);

/// The edges whose flag is set, in their order.
ReferenceEdges select_edges(const ReferenceEdges& edges, const std::vector<std::uint8_t>& kept);

}  // namespace quadedge::reference
