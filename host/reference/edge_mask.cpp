#include "reference/edge_mask.hpp"

#include "common/images.hpp"
#include "reference/edge_selection.hpp"

namespace quadedge::reference {

ReferenceEdges outside_mask(const ReferenceEdges& edges, const PixelMask& mask, int margin) {
  if (mask.empty()) return edges;
  const PixelMask wide = with_border(mask, margin);
  std::vector<std::uint8_t> kept;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const int x = edges.column[i], y = edges.row[i];
    kept.push_back(
        wide.hidden[static_cast<std::size_t>(y) * static_cast<std::size_t>(wide.width) + static_cast<std::size_t>(x)] ==
                0
            ? 1
            : 0);
  }
  return select_edges(edges, kept);
}

}  // namespace quadedge::reference
