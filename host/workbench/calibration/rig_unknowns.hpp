#pragma once
/// \file rig_unknowns.hpp  A calibration as a few numbers that may be wrong, and how wrong they usually are.

#include <Eigen/Core>
#include <string>
#include <vector>

#include "quadedge/calibration.hpp"
#include "quadedge/drive_calibration.hpp"

namespace quadedge::rig {

/// The numbers of a calibration that a drive can tell: two lenses, their focal lengths and principal points, the
/// rotation of the right camera and the direction of the baseline. The length of the baseline stays as given.
class RigUnknowns {
 public:
  /// Derivative of a pixel by all unknowns.
  using PixelByUnknowns = Eigen::Matrix<double, 2, Eigen::Dynamic, 0, 2, 32>;

  /// \param has_k3 whether k3 of Brown's lenses is unknown; otherwise it stays as given
  explicit RigUnknowns(StereoCalibration given, bool has_k3 = true);

  static constexpr const char* kCommonFocal = "focal length, both";  ///< the name of this unknown

  int count() const { return static_cast<int>(unknowns_.size()); }
  /// As long as nothing is learned.
  const LearnedNumber& operator[](int i) const { return unknowns_[static_cast<std::size_t>(i)]; }
  const StereoCalibration& given() const { return given_; }
  Eigen::VectorXd priors() const;
  StereoCalibration at(const Eigen::VectorXd& values) const;

  /// A number of one camera, and how it depends on the unknowns. Focal lengths are relative.
  enum CameraNumber { kFocalX, kFocalY, kCentreX, kCentreY, kFirstLensParameter };
  /// Rows: CameraNumber, then the lens parameters in lens_parameters().
  const Eigen::MatrixXd& by_unknowns(Side side) const { return by_unknowns_[index_of(side)]; }
  /// Indices of the parameters of the lens that are unknown.
  const std::vector<int>& lens_parameters(Side side) const { return lens_parameters_[index_of(side)]; }
  int first_rotation() const { return first_rotation_; }  ///< of three unknowns, then two of the baseline's direction
  /// Axes of the right camera that the three rotations turn it about, in columns.
  const Eigen::Matrix3d& rotation_axes() const { return rotation_axes_; }
  /// Derivative of the baseline's vector by its two directions, at the given calibration.
  Eigen::Matrix<double, 3, 2> baseline_slope() const {
    return given_.right_from_left.translation().norm() * baseline_axes_;
  }

 private:
  int add(std::string name, std::string unit, double prior);
  void add_cameras();
  void add_lens(Side side);
  void add_pose();

  StereoCalibration given_;
  bool has_k3_;
  std::vector<LearnedNumber> unknowns_;
  Eigen::MatrixXd by_unknowns_[2];
  std::vector<int> lens_parameters_[2];
  Eigen::Matrix3d rotation_axes_;
  Eigen::Matrix<double, 3, 2> baseline_axes_;
  int first_rotation_ = 0;
  bool is_horizontal_ = true;  ///< whether the baseline lies along the rows
};

}  // namespace quadedge::rig
