#include "odometry/still_camera.hpp"

namespace quadedge::odometry {

StepHandle StillCamera::propose(const MotionQuery& query, const Evidence&) {
  StepHandle step = steps_.take(query.base);
  step->motion = {};
  step->motion.status = pose::MotionStatus::ok;
  return step;
}

}  // namespace quadedge::odometry
