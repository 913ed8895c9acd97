#pragma once
/// \file explained_cells.hpp  Which parts of the current left image a motion explains.

#include <vector>

#include "quadedge/camera.hpp"

namespace quadedge::motion {

/// The edges of a base that a motion brings into one cell of the image: how many there are, how many of them were found
/// again, and how many of those the motion explains.
struct ExplainedCell {
  double edges = 0, found = 0, explained = 0;

  /// Whether enough of the edges found again follow the motion.
  bool follows() const;
  /// Whether another motion may be found here: the cell does not follow, or the motion brings no edges into it.
  bool is_free() const { return !(edges > 0) || !follows(); }
};

/// The current left image in square cells of pose.scoring_cell px.
class ExplainedCells {
 public:
  /// Empties the cells and keeps the memory. \param side [px]; 0: a single cell
  void start(const PinholeCamera& camera, double side);
  void clear() { cells_.clear(); }

  /// The cell of a position [px]; null outside the image or for NaN.
  ExplainedCell* at(float x, float y);
  const ExplainedCell* at(float x, float y) const { return const_cast<ExplainedCells*>(this)->at(x, y); }
  /// Row-major.
  const std::vector<ExplainedCell>& all() const { return cells_; }
  std::vector<ExplainedCell>& all() { return cells_; }

  /// Mean over the cells with edges of the fraction of edges that the motion explains; 0 without edges.
  double explained_area() const;
  /// Standard deviation of the positions of the cells that hold edges, or only of those that follow [cells].
  double spread(bool only_following) const;
  /// Number of cells that hold edges and follow, or do not.
  int count(bool following) const;
  /// Fraction of the edges that lie in cells that do not follow the motion; 0 without edges.
  double moving_ratio() const;

 private:
  double side_ = 1;
  int columns_ = 1, rows_ = 0;
  std::vector<ExplainedCell> cells_;
};

}  // namespace quadedge::motion
