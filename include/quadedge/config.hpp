#pragma once
/// \file config.hpp  Every constant of the method with its default. Angles are degrees here and radians inside.
///
/// The structs are the single source of truth: flags and `--config FILE.toml` carry the same names (`stereo.ncc_min`).

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <variant>

namespace quadedge {

/// Third-order edge detection, doc/method.md section 1.
struct EdgesConfig {
  double sigma = 2.0;                     ///< Gaussian scale [px]
  double threshold = 2.0;                 ///< smallest gradient magnitude [grey levels per px], exclusive
  int margin = 10;                        ///< no edge nearer to the image border [px]
  std::string direction_at = "subpixel";  ///< where the third-order direction is evaluated: subpixel | cell
  double newton_max = 0.1;  ///< longest step from the parabola's peak onto F = 0, not taken with "cell"; 0: none [px]
  bool thinning = false;    ///< keep one edge per pixel along a curve
  int max_edges = 200000;   ///< capacity per image; more is an overflow that the frame reports
};

/// Side patches, doc/method.md section 2.
struct PatchesConfig {
  double offset = 5.0;  ///< distance of the patch centres from the edge [px]
};

/// SIFT descriptors of both sides, doc/method.md section 2.
struct SiftConfig {
  double offset = 8.0;  ///< distance of the key points from the edge [px]
};

/// Stereo cascade, doc/method.md section 3.
struct StereoConfig {
  double epipolar_distance = 0.5;   ///< [px]
  double min_depth = 0.0;           ///< nearest depth [m]; 0: from max_disparity, or else from the data set's reader
  double max_disparity = 0.0;       ///< largest disparity [px]; 0: from min_depth, or else from the data set's reader
  double orientation = 10.0;        ///< [deg], modulo 360: contrast keeps its sign
  double sift_max = 0.0;            ///< largest SIFT distance (the paper: 500); 0: without SIFT
  double ncc_min = 0.4;             ///< smallest NCC; the refined places are judged more strictly
  double ncc_nearly_best = 0.9;     ///< share of the best NCC that is kept
  double sift_nearly_best = 0.4;    ///< best distance / distance that is kept
  double min_epipolar_angle = 4.0;  ///< edges nearer to their epipolar line take no part [deg]
  double shift_min_angle = 12.0;    ///< below it the orthogonal projection replaces the shift along the tangent [deg]
  double shift_max = 3.0;           ///< longest shift along the tangent [px]
  int refine_steps = 8;             ///< Gauss-Newton steps
  double refine_tolerance = 0.05;   ///< [px]
  double refine_huber = 3.0;        ///< [grey levels]
  double refine_clamp = 2.0;        ///< longest move along the line [px]
  double refine_prior_sigma =
      0.1;  ///< spread of a detected edge across itself [px], more along a line that it is flat to
  double refine_noise_sigma = 5.0;  ///< difference of two true patches that the prior is weighed against [grey levels]
  double refined_ncc_min = 0.75;    ///< smallest likeness of the refined places: mean of the centre's and a side's NCC
  double cluster_gap = 1.0;         ///< [px]
  double cluster_orientation = 20.0;  ///< [deg]
  int cluster_size_max = 10;          ///< members
  double cluster_sigma = 2.0;         ///< of the weights in the mean direction of a cluster [px]
  double mutual_radius = 4.0;         ///< left edges nearer than this share one right edge [px]
};

/// Temporal cascade, doc/method.md section 4.
struct TemporalConfig {
  double radius = 3.0;  ///< around the place that the scouted motion predicts [px]
  double distance_weight =
      0.2;  ///< NCC that a candidate at the end of the radius has to be better than one at the predicted place
  double coarse_radius = 10.0;  ///< around the place that constant velocity predicts [px]
  int wide_edges = 3000;  ///< where there is no prediction, or it fails: so many are looked for anywhere, among twice
                          ///< as many; 0: none
  double coarse_wide_radius_ratio = 0.1;  ///< scout's radius there with wide_edges = 0 [share of the image width]
  double wide_ratio = 0.8;           ///< distance of descriptors / distance of the best rival elsewhere that is kept
  double wide_neighbourhood = 12.0;  ///< what is nearer is no rival [px]
  double wide_inlier_distance =
      4.0;                  ///< replaces pose.inlier_distance: found places are neighbours of the right one [px]
  int coarse_edges = 4000;  ///< the scout looks for about this many stereo edges; its motion then predicts for all
  double confident_support =
      0.35;  ///< a motion that less supports, see min_support, has to agree with edges found anywhere
  double min_support =
      0.06;  ///< inliers, share of the base's edges that the motion brings into view: a wrong one finds about 0.03
  int rounds = 3;  ///< searches at most, each around what the last one found, until the places stay
  double coarse_min_inlier_ratio = 0.03;  ///< of the scout's quads; the search that follows has to convince
  double coarse_ncc_min = 0.8;
  double coarse_sift_max = 0.0;         ///< around a prediction; 0: without SIFT
  double coarse_wide_sift_max = 200.0;  ///< in the wider circles
  double coarse_ncc_nearly_best = 0.9;
  double coarse_sift_nearly_best = 0.6;
  double orientation = 10.0;  ///< [deg], modulo 360
  double ncc_min = 0.6;
  double sift_max = 0.0;  ///< 0: without SIFT, which tells nothing more within a few pixels
  double ncc_nearly_best = 0.8;
  double sift_nearly_best = 0.4;
  double cluster_gap = 1.0;           ///< [px]
  double cluster_orientation = 20.0;  ///< [deg]
};

/// Pose from quads, doc/method.md section 6.
struct PoseConfig {
  double length_difference = 0.13;   ///< constraint 1: relative difference of |D|
  double angle_difference = 0.12;    ///< constraints 2 and 3: difference of the cosines between D and a tangent
  double tangent_difference = 0.32;  ///< constraint 4: difference of T1.T2
  double min_angle = 14.0;           ///< constraint 5: D at least this far from T1 [deg]
  double min_determinant = 0.1;      ///< constraint 6 is informative above this magnitude
  double inlier_distance = 1.5;      ///< [px], in both images
  double inlier_orientation = 10.0;  ///< [deg]
  double confidence = 0.999;         ///< of having drawn an outlier-free sample
  int min_hypotheses = 100;          ///< scored before the confidence may stop the search
  int max_hypotheses = 2000;
  int max_draws = 100000;           ///< pairs drawn at most, those that fail the constraints included
  double min_pair_distance = 0.05;  ///< of a sample's two quads in the image, share of the image diagonal
  double scoring_cell = 32.0;  ///< square cells of the image have the same say about hypotheses, however many edges
                               ///< they hold [px]; 0: quads have
  int scoring_quads = 4096;    ///< quads on which promising hypotheses are compared
  int preview_quads = 512;     ///< quads on which all hypotheses are compared
  double local_optimisation_widening =
      4.0;  ///< inlier distance of raw samples and of the local optimisation's start, times inlier_distance
  int local_optimisation_rounds =
      3;  ///< rounds of the local optimisation, narrowing to inlier_distance; 0: samples are not polished at all
  bool refine = true;            ///< least squares over the inliers at the end
  int refine_rounds = 4;         ///< selections of inliers, each followed by a fit
  int fit_steps = 5;             ///< Gauss-Newton steps of one fit
  double sigma_across = 0.12;    ///< noise of an edge's place across the edge [px]
  double sigma_along = 0.5;      ///< and along it [px]
  double sigma_direction = 2.0;  ///< noise of an edge's direction in the image [deg]
  double slope_prior =
      1.0;  ///< plausible depth slope of a tangent; tempers slopes that are mostly noise when inliers are told
  double fit_tolerance = 0.01;   ///< a step shorter than this share of the pose's standard deviation ends a fit
  double student_dof = 5.0;      ///< degrees of freedom of the residuals' Student-t distribution; small: robust
  double inflation_cell = 16.0;  ///< edges of one square cell of this side may share their error [px]
  double disparity_offset_sigma =
      0.3;  ///< of an unknown offset that all disparities share, at the start [px]; 0: there is none
  double disparity_offset_drift = 0.003;  ///< growth of its standard deviation per frame [px]
  int min_inliers = 12;
  double min_inlier_ratio = 0.15;
  double min_spread = 0.1;  ///< standard deviation of the inliers' place, share of the image diagonal
};

/// Key stereo rig, doc/method.md section 7.
struct OdometryConfig {
  bool key_rig = true;              ///< false: frame to frame only
  double key_min_quad_ratio = 0.3;  ///< quads with the key rig, share of those at its first frame
  int key_min_quads = 300;
  double key_min_inlier_ratio = 0.4;
  double key_max_parallax = 16.0;  ///< median [px]
  double key_max_rotation = 10.0;  ///< [deg]
  int key_max_frames = 10;
};

/// The whole configuration.
struct Config {
  EdgesConfig edges;
  PatchesConfig patches;
  SiftConfig sift;
  StereoConfig stereo;
  TemporalConfig temporal;
  PoseConfig pose;
  OdometryConfig odometry;
  std::uint64_t seed = 42;                      ///< the only source of randomness
  std::map<std::string, std::string> variants;  ///< stage -> kernel variant; a missing stage takes the device's default
};

/// A pointer to one field of a Config.
using ConfigField = std::variant<double*, int*, bool*, std::string*, std::uint64_t*>;

/// Calls `visit(name, field, help, low, high)` for every scalar field, in a fixed order; `name` is "section.field" or
/// "seed". Allowed values are low..high (numbers only). Command line, file reader, file writer and check all use this
/// one list.
void visit_config(Config& config, const std::function<void(const std::string& name, ConfigField field,
                                                           const std::string& help, double low, double high)>& visit);

/// \throws UsageError that names the first field outside its range, its value and the range.
void check_config(const Config& config);

}  // namespace quadedge
