/// \file config.cpp  The one list of configuration fields with their help and ranges (include/quadedge/config.hpp).
#include "quadedge/config.hpp"

#include <cmath>
#include <limits>
#include <sstream>

#include "quadedge/error.hpp"

namespace quadedge {
namespace {

constexpr double kUnlimited = std::numeric_limits<double>::infinity();
constexpr double kLargestInt = std::numeric_limits<int>::max();

std::string number(double value) {
  std::ostringstream text;
  text.precision(12);
  text << value;
  return text.str();
}

/// Throws unless `value` is finite and within low..high.
void check_range(const std::string& name, double value, double low, double high) {
  if (std::isfinite(value) && value >= low && value <= high) return;
  const std::string range = std::isfinite(high) ? number(low) + " to " + number(high) : "at least " + number(low);
  throw UsageError(name + " is " + number(value) + "; allowed: " + range);
}

}  // namespace

void visit_config(Config& config, const std::function<void(const std::string& name, ConfigField field,
                                                           const std::string& help, double low, double high)>& visit) {
  auto& edges = config.edges;
  visit("edges.sigma", &edges.sigma, "Gaussian scale of the derivatives [px]", 0.5, 8);
  visit("edges.threshold", &edges.threshold, "smallest gradient magnitude, exclusive [grey levels/px]", 0, 255);
  visit("edges.margin", &edges.margin, "no edge nearer to the image border [px]", 1, 1000);
  visit("edges.direction_at", &edges.direction_at, "where the direction is evaluated: subpixel or cell", 0, 0);
  visit("edges.newton_max", &edges.newton_max,
        "longest step from the parabola's peak onto F = 0, not with cell; 0: none [px]", 0, 0.14);
  visit("edges.thinning", &edges.thinning, "keep one edge per pixel along a curve", 0, 1);
  visit("edges.max_edges", &edges.max_edges, "capacity per image", 1, 4000000);

  visit("patches.offset", &config.patches.offset, "distance of the side patches from the edge [px]", 1, 50);
  visit("sift.offset", &config.sift.offset, "distance of the SIFT key points from the edge [px]", 1, 50);

  auto& stereo = config.stereo;
  visit("stereo.epipolar_distance", &stereo.epipolar_distance, "largest distance to the epipolar line [px]", 0, 20);
  visit("stereo.min_depth", &stereo.min_depth, "nearest depth; 0: from max_disparity [m]", 0, kUnlimited);
  visit("stereo.max_disparity", &stereo.max_disparity, "largest disparity; 0: from min_depth or the data's reader [px]",
        0, 10000);
  visit("stereo.orientation", &stereo.orientation, "largest difference of directions, modulo 360 [deg]", 0, 90);
  visit("stereo.sift_max", &stereo.sift_max, "largest SIFT distance; 0: without SIFT", 0, kUnlimited);
  visit("stereo.ncc_min", &stereo.ncc_min, "smallest NCC", 0.01, 1);
  visit("stereo.ncc_nearly_best", &stereo.ncc_nearly_best, "share of the best NCC that is kept", 0, 1);
  visit("stereo.sift_nearly_best", &stereo.sift_nearly_best, "ratio of best SIFT distance to distance that is kept", 0,
        1);
  visit("stereo.min_epipolar_angle", &stereo.min_epipolar_angle,
        "edges nearer to their epipolar line take no part [deg]", 0, 90);
  visit("stereo.shift_min_angle", &stereo.shift_min_angle,
        "below it a projection replaces the shift along the tangent [deg]", 0, 90);
  visit("stereo.shift_max", &stereo.shift_max, "longest shift along the tangent [px]", 0, 100);
  visit("stereo.refine_steps", &stereo.refine_steps, "Gauss-Newton steps of the refinement", 0, 100);
  visit("stereo.refine_tolerance", &stereo.refine_tolerance, "step that ends the refinement [px]", 0, 1);
  visit("stereo.refine_huber", &stereo.refine_huber, "Huber threshold of the refinement [grey levels]", 0.01, 255);
  visit("stereo.refine_clamp", &stereo.refine_clamp, "longest move of the refinement along the line [px]", 0, 100);
  visit("stereo.refine_prior_sigma", &stereo.refine_prior_sigma, "spread of a detected edge across itself [px]", 0.001,
        100);
  visit("stereo.refine_noise_sigma", &stereo.refine_noise_sigma,
        "difference of true patches that the prior is weighed against [grey levels]", 0, 255);
  visit("stereo.refined_ncc_min", &stereo.refined_ncc_min,
        "smallest likeness (NCC of centre and a side) of the refined places", 0.01, 1);
  visit("stereo.cluster_gap", &stereo.cluster_gap, "gap that separates two clusters [px]", 0, 100);
  visit("stereo.cluster_orientation", &stereo.cluster_orientation,
        "change of direction that separates two clusters [deg]", 0, 90);
  visit("stereo.cluster_size_max", &stereo.cluster_size_max, "most members of a cluster", 1, 1000);
  visit("stereo.cluster_sigma", &stereo.cluster_sigma, "width of the weights in a cluster's mean direction [px]", 0.01,
        100);
  visit("stereo.mutual_radius", &stereo.mutual_radius, "left edges nearer than this may share one right edge [px]", 0,
        100);

  auto& temporal = config.temporal;
  visit("temporal.radius", &temporal.radius, "search radius around the place that the scouted motion predicts [px]",
        0.1, 1000);
  visit("temporal.distance_weight", &temporal.distance_weight,
        "NCC that a candidate at the end of the radius has to be better", 0, 1);
  visit("temporal.confident_support", &temporal.confident_support,
        "a motion with a smaller support has to agree with edges found anywhere [share of the edges in view]", 0, 1);
  visit("temporal.min_support", &temporal.min_support, "smallest share of inliers among the base's edges in view", 0,
        1);
  visit("temporal.rounds", &temporal.rounds, "searches at most, each around what the last one found", 1, 10);
  visit("temporal.coarse_radius", &temporal.coarse_radius,
        "scout's radius around the place that constant velocity predicts [px]", 0.1, 1000);
  visit("temporal.coarse_wide_radius_ratio", &temporal.coarse_wide_radius_ratio,
        "scout's radius where there is no prediction, or it fails, with wide_edges = 0 [share of the image width]",
        0.001, 1);
  visit("temporal.wide_edges", &temporal.wide_edges,
        "edges looked for anywhere where there is no prediction, or it fails; 0: none", 0, 1000000);
  visit("temporal.wide_ratio", &temporal.wide_ratio,
        "then: distance / distance of the best rival elsewhere that is kept", 0.01, 1);
  visit("temporal.wide_neighbourhood", &temporal.wide_neighbourhood, "then: what is nearer is no rival [px]", 0, 1000);
  visit("temporal.wide_inlier_distance", &temporal.wide_inlier_distance,
        "then: reprojection distance of an inlier [px]", 0.01, 100);
  visit("temporal.coarse_edges", &temporal.coarse_edges, "the scout looks for about this many stereo edges", 100,
        1000000);
  visit("temporal.coarse_min_inlier_ratio", &temporal.coarse_min_inlier_ratio,
        "smallest inlier share of the scout's quads", 0, 1);
  visit("temporal.coarse_ncc_min", &temporal.coarse_ncc_min, "scout's smallest NCC", 0.01, 1);
  visit("temporal.coarse_sift_max", &temporal.coarse_sift_max,
        "scout's largest SIFT distance around a prediction; 0: without SIFT", 0, kUnlimited);
  visit("temporal.coarse_wide_sift_max", &temporal.coarse_wide_sift_max, "and in the wider circles; 0: without SIFT", 0,
        kUnlimited);
  visit("temporal.coarse_ncc_nearly_best", &temporal.coarse_ncc_nearly_best,
        "scout's share of the best NCC that is kept", 0, 1);
  visit("temporal.coarse_sift_nearly_best", &temporal.coarse_sift_nearly_best,
        "scout's ratio of best SIFT distance to distance that is kept", 0, 1);
  visit("temporal.orientation", &temporal.orientation, "largest difference of directions, modulo 360 [deg]", 0, 180);
  visit("temporal.ncc_min", &temporal.ncc_min, "smallest NCC", 0.01, 1);
  visit("temporal.sift_max", &temporal.sift_max, "largest SIFT distance; 0: without SIFT", 0, kUnlimited);
  visit("temporal.ncc_nearly_best", &temporal.ncc_nearly_best, "share of the best NCC that is kept", 0, 1);
  visit("temporal.sift_nearly_best", &temporal.sift_nearly_best, "ratio of best SIFT distance to distance that is kept",
        0, 1);
  visit("temporal.cluster_gap", &temporal.cluster_gap, "gap that separates two clusters [px]", 0, 100);
  visit("temporal.cluster_orientation", &temporal.cluster_orientation,
        "change of direction that separates two clusters [deg]", 0, 180);

  auto& pose = config.pose;
  visit("pose.length_difference", &pose.length_difference, "constraint 1: relative difference of lengths", 0, 1);
  visit("pose.angle_difference", &pose.angle_difference, "constraints 2 and 3: difference of cosines", 0, 2);
  visit("pose.tangent_difference", &pose.tangent_difference, "constraint 4: difference of the tangents' cosine", 0, 2);
  visit("pose.min_angle", &pose.min_angle, "constraint 5: chord at least this far from the tangent [deg]", 0, 90);
  visit("pose.min_determinant", &pose.min_determinant, "constraint 6 counts above this magnitude", 0, 1);
  visit("pose.inlier_distance", &pose.inlier_distance, "reprojection distance of an inlier, both images [px]", 0, 100);
  visit("pose.inlier_orientation", &pose.inlier_orientation, "difference of directions of an inlier [deg]", 0, 180);
  visit("pose.confidence", &pose.confidence, "of having drawn a sample without outliers", 0, 0.999999999);
  visit("pose.min_hypotheses", &pose.min_hypotheses, "RANSAC hypotheses before the confidence may stop it", 0,
        10000000);
  visit("pose.max_hypotheses", &pose.max_hypotheses, "most RANSAC hypotheses", 1, 10000000);
  visit("pose.max_draws", &pose.max_draws, "most pairs drawn, rejected ones included", 1, kLargestInt);
  visit("pose.min_pair_distance", &pose.min_pair_distance, "between a sample's quads [share of the image diagonal]", 0,
        1);
  visit("pose.scoring_cell", &pose.scoring_cell, "cells that have the same say about hypotheses; 0: quads have [px]", 0,
        1000);
  visit("pose.scoring_quads", &pose.scoring_quads, "quads on which promising hypotheses are compared", 2, kLargestInt);
  visit("pose.preview_quads", &pose.preview_quads, "quads on which all hypotheses are compared", 2, kLargestInt);
  visit("pose.local_optimisation_widening", &pose.local_optimisation_widening,
        "first inlier distance of the local optimisation, times inlier_distance", 1, 100);
  visit("pose.local_optimisation_rounds", &pose.local_optimisation_rounds,
        "rounds of the local optimisation; 0: samples are not polished at all", 0, 100);
  visit("pose.refine", &pose.refine, "least squares over the inliers at the end", 0, 1);
  visit("pose.refine_rounds", &pose.refine_rounds, "selections of inliers, each followed by a fit", 1, 100);
  visit("pose.fit_steps", &pose.fit_steps, "Gauss-Newton steps of one fit", 1, 100);
  visit("pose.sigma_across", &pose.sigma_across, "noise of an edge's place across the edge [px]", 1e-6, 100);
  visit("pose.sigma_along", &pose.sigma_along, "noise of an edge's place along the edge [px]", 1e-6, 1000);
  visit("pose.sigma_direction", &pose.sigma_direction, "noise of an edge's direction in the image [deg]", 1e-6, 90);
  visit("pose.slope_prior", &pose.slope_prior, "plausible depth slope of a tangent, for telling inliers", 1e-6, 1e6);
  visit("pose.fit_tolerance", &pose.fit_tolerance, "step that ends a fit [share of the standard deviation]", 0, 1);
  visit("pose.student_dof", &pose.student_dof, "degrees of freedom of the residuals' Student-t distribution", 1,
        1000000);
  visit("pose.inflation_cell", &pose.inflation_cell, "side of the cells whose edges may share their error [px]", 1,
        1000);
  visit("pose.disparity_offset_sigma", &pose.disparity_offset_sigma,
        "spread of an offset that all disparities share; 0: there is none [px]", 0, 10);
  visit("pose.disparity_offset_drift", &pose.disparity_offset_drift, "growth of that spread per frame [px]", 0, 10);
  visit("pose.min_inliers", &pose.min_inliers, "fewer give no pose", 2, kLargestInt);
  visit("pose.min_inlier_ratio", &pose.min_inlier_ratio, "a smaller share gives no pose", 0, 1);
  visit("pose.min_spread", &pose.min_spread, "smallest spread of the inliers [share of the image diagonal]", 0, 1);

  auto& odometry = config.odometry;
  visit("odometry.key_rig", &odometry.key_rig, "track against a key stereo rig; false: frame to frame only", 0, 1);
  visit("odometry.key_min_quad_ratio", &odometry.key_min_quad_ratio, "new key rig below this share of quads", 0, 1);
  visit("odometry.key_min_quads", &odometry.key_min_quads, "new key rig below this number of quads", 0, kLargestInt);
  visit("odometry.key_min_inlier_ratio", &odometry.key_min_inlier_ratio, "new key rig below this share of inliers", 0,
        1);
  visit("odometry.key_max_parallax", &odometry.key_max_parallax, "new key rig above this median parallax [px]", 0,
        10000);
  visit("odometry.key_max_rotation", &odometry.key_max_rotation, "new key rig above this rotation [deg]", 0, 180);
  visit("odometry.key_max_frames", &odometry.key_max_frames, "new key rig after this many frames", 1, kLargestInt);

  visit("seed", &config.seed, "seed of all random choices", 0, kUnlimited);
}

void check_config(const Config& config) {
  Config copy = config;  // visit_config hands out pointers that may write
  visit_config(copy, [](const std::string& name, ConfigField field, const std::string&, double low, double high) {
    if (const auto* real = std::get_if<double*>(&field)) check_range(name, **real, low, high);
    if (const auto* whole = std::get_if<int*>(&field)) check_range(name, **whole, low, high);
  });
  if (config.edges.direction_at != "subpixel" && config.edges.direction_at != "cell") {
    throw UsageError("edges.direction_at is '" + config.edges.direction_at + "'; allowed: subpixel, cell");
  }
}

}  // namespace quadedge
