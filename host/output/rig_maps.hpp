#pragma once
/// \file rig_maps.hpp  What a run shows of its rig over the right image: by how much points lie off their rows and
/// columns, with the calibration as given (before) and with what the run has learned (after).

#include <array>
#include <string>
#include <vector>

#include "common/numeric.hpp"
#include "quadedge/camera.hpp"

namespace quadedge::report {

/// Medians of a quantity over the cells of an image, from a bounded number of evenly spaced samples each.
class CellMap {
 public:
  static constexpr int kColumns = 12, kRows = 8;

  /// \param u, v from 0 to 1 over the image; samples outside it are left out
  void add(double u, double v, double value);

  /// NaN for a cell of few samples.
  double median(int column, int row) const;
  int samples(int column, int row) const { return cell(column, row).seen; }

  /// Of the cells that have a median; NaN without any.
  struct Summary {
    int cells = 0;
    double rms = kNan, largest = kNan;  ///< of the medians; the one of the largest magnitude
    double scatter = kNan;              ///< of single samples about them, as the standard deviation of normal errors
    double noise = kNan;                ///< rms that this scatter alone would give, if samples were independent
  };
  Summary summary() const;

 private:
  struct Cell {
    std::vector<float> values;  ///< every `every`-th sample
    int seen = 0, every = 1;
  };
  const Cell& cell(int column, int row) const { return cells_[static_cast<std::size_t>(row * kColumns + column)]; }

  std::array<Cell, kColumns * kRows> cells_;
};

/// All of [px]. Rows (vertical residuals): distances of aligned patches from their epipolar lines, in every frame that
/// was located. Columns (horizontal residuals): measured minus predicted disparity of the quads at a new keyframe; the
/// prediction uses the points of the previous keyframe and the estimated motion.
struct RigMaps {
  struct Offset {
    double value = 0, sigma = 0;
  };
  CellMap rows_before, rows_after, columns_before, columns_after;
  Offset offset_start, offset_end;  ///< of all disparities
  double disparity_error = 0;       ///< see RigEstimate
  double row_correction = 0;        ///< largest distance that the search of the last frame allowed for
  double frames = 0;                ///< that the learned rows rest on
  int width = 0, height = 0;        ///< of the right image

  bool is_empty() const { return rows_before.summary().cells == 0; }
};

/// rig_maps.csv: a row per cell with its number, the position of its centre, medians and samples.
std::string rig_maps_csv(const RigMaps& maps);

}  // namespace quadedge::report
