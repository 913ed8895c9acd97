#pragma once
/// \file moving_cells.hpp  Cells of the image that move otherwise than the camera's motion has it, beyond the noise of
/// the frame.

#include <Eigen/Geometry>

#include "motion/motion_step.hpp"

namespace quadedge::odometry {

/// What moves, as far as the image shows it.
struct MovingCells {
  int count = 0;
  double spread = 0;            ///< standard deviation of their positions [cells]
  Eigen::AlignedBox2d largest;  ///< of the largest group of adjacent ones, in the left image [px]; empty without any
};

/// The cells that do not follow a motion although so few of their edges agree with it by chance only where the scene
/// does not follow either. Weak edges flicker: the rate at which edges agree in the cells that follow is the measure of
/// it, and a cell of few edges shows nothing.
MovingCells find_moving_cells(const ExplainedCells& cells);

}  // namespace quadedge::odometry
