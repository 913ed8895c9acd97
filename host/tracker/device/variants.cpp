/// \file variants.cpp  The table of variants, and the programs that CPUs build for several stages at once.
#include "device/variants.hpp"

#include <algorithm>

#include "quadedge/error.hpp"

namespace quadedge::opencl {

cl::Program Variant::program(Context& context, Defines others) const {
  others.insert(defines.begin(), defines.end());
  return default_on_cpu ? joint_program(context, files, others) : context.program(files, others);
}

const std::vector<Variant>& all_variants() {
  // LONG: a table, one row per variant, ordered by stage.
  // clang-format off
  static const std::vector<Variant> table = {
      {"undistortion", "pixels16", {"undistortion.cl"}, Form::items, {{"PIXELS", "16"}}, 64, true, false,
       "one work-item per 16 pixels, float16, groups of 64"},
      {"undistortion", "item64", {"undistortion.cl"}, Form::items, {}, 64, false, true,
       "one work-item per pixel, groups of 64"},
      {"smoothing", "item64", {"smoothing.cl"}, Form::items, {}, 64, true, true,
       "one work-item per pixel, groups of 64"},
      {"scan", "serial", {"scan.cl"}, Form::items, {}, 1, true, false, "one work-item per part of the counts"},
      {"scan", "group256", {"scan.cl"}, Form::groups, {}, 256, false, true,
       "work-groups of 256 with their sums in local memory", 2048},
      {"edge_threshold", "row", {"edge_detection.cl", "edge_threshold.cl"}, Form::items, {}, 1, true, false,
       "one work-item per row of the lattice, float16"},
      {"edge_threshold", "group256", {"edge_detection.cl", "edge_threshold.cl"}, Form::groups, {}, 256, false, true,
       "one work-group of 256 per row of the lattice, local tallies", 3456},
      {"edge_threshold", "group64", {"edge_detection.cl", "edge_threshold.cl"}, Form::groups, {}, 64, false, false,
       "one work-group of 64 per row of the lattice, local tallies", 1920},
      {"edge_detection", "strip", {"edge_detection.cl", "edge_detection_strip.cl"}, Form::items, {}, 1, true, false,
       "work-items walk along rows with float16, 8 lanes per edge for third order"},
      {"edge_detection", "tile256", {"edge_detection.cl", "edge_detection_tile.cl"},
       Form::groups, {{"TILE_X", "32"}, {"TILE_Y", "8"}}, 256, false, true,
       "one work-group of 256 per tile of 32 x 8 pixels, 8 work-items per edge for third order", 15872},
      {"edge_detection", "tile64", {"edge_detection.cl", "edge_detection_tile.cl"},
       Form::groups, {{"TILE_X", "16"}, {"TILE_Y", "16"}}, 64, false, false,
       "one work-group of 64 per tile of 16 x 16 pixels, 8 work-items per edge for third order", 8192},
      {"grid_edges", "rows32", {"edge_detection.cl", "grid_edges.cl"},
       Form::items, {{"STRIP_ROWS", "32"}}, 1, true, false,
       "work-items walk along 32 rows of the grid with float16, 8 lanes per edge for third order"},
      {"grid_edges", "rows4", {"edge_detection.cl", "grid_edges.cl"},
       Form::items, {{"STRIP_ROWS", "4"}}, 1, false, true,
       "the same with 4 rows, for more work-items"},
      {"patches", "edge", {"direction.cl", "photometric.cl", "patches.cl"}, Form::items, {}, 1, true, false,
       "one work-item per edge, float8 across the edge"},
      {"patches", "lanes", {"direction.cl", "photometric.cl", "photometric_lanes.cl", "patches.cl"},
       Form::groups, {{"GROUP", "64"}}, 64, false, true, "sixteen work-items per edge, local memory", 1024},
      {"sift", "edge", {"direction.cl", "sift.cl"}, Form::items, {}, 1, true, false,
       "one work-item per edge, float8 of angle bins"},
      {"sift", "cells", {"direction.cl", "sift.cl"}, Form::groups, {{"GROUP", "64"}}, 64, false, true,
       "one work-item per cell of either side, local memory", 14336},
      {"stereo_candidates", "lanes16", {"direction.cl", "epipolar.cl", "stereo_candidates.cl"},
       Form::items, {}, 16, true, true, "one work-item per left edge tests 16 right edges at once, groups of 16"},
      {"candidate_filters", "group64", {"described_edges.cl", "similarity.cl", "candidate_filters.cl"},
       Form::items, {}, 64, true, true, "one work-item per row of candidates, groups of 64"},
      {"paper_filters", "rows4", {"described_edges.cl", "similarity.cl", "paper_filters.cl", "candidate_filters.cl"},
       Form::items, {{"KNOWN_NCC", "1"}}, 16, true, true,
       "one work-item per row of candidates compares four at once, float16 of a patch's row, groups of 16"},
      {"stereo_refinement", "group64", {"direction.cl", "epipolar.cl", "photometric.cl", "candidate_positions.cl",
        "stereo_refinement.cl"},
       Form::items, {}, 64, true, false, "one work-item per left edge, float8 across the edge, groups of 64"},
      {"stereo_refinement", "lanes64", {"direction.cl", "epipolar.cl", "photometric.cl", "photometric_lanes.cl",
        "candidate_positions.cl", "stereo_refinement_lanes.cl"},
       Form::groups, {{"GROUP", "64"}}, 64, false, true,
       "eight work-items per left edge, its patches in local memory, groups of 64", 3584},
      {"stereo_clusters", "group64", {"direction.cl", "stereo_clusters.cl"}, Form::items, {}, 64, true, true,
       "one work-item per left edge, groups of 64"},
      {"paper_patches", "edge", {"direction.cl", "paper_sides.cl", "paper_patches.cl"}, Form::items, {}, 16, true, true,
       "one work-item per pixel or edge, float16 of both sides, groups of 16"},
      {"paper_refinement", "row", {"direction.cl", "epipolar.cl", "paper_sides.cl", "paper_refinement.cl"},
       Form::items, {}, 16, true, true, "one work-item per row of candidates, float16 of both sides, groups of 16"},
      {"paper_clusters", "row", {"direction.cl", "paper_sides.cl", "paper_clusters.cl"},
       Form::items, {}, 16, true, true,
       "one work-item per row of candidates, groups of 16"},
      {"paper_quads", "row", {"paper_quads.cl"}, Form::items, {}, 16, true, true,
       "one work-item per previous stereo edge, groups of 16"},
      {"coarse_disparity", "rows", {"coarse_planes.cl", "coarse_disparity.cl"},
       Form::items, {{"COLUMNS", "8"}}, 1, true, false,
       "one work-item per row or eight columns, ushort16 of disparities"},
      {"coarse_disparity", "group64", {"coarse_planes.cl", "coarse_disparity_groups.cl"},
       Form::groups, {{"COLUMNS", "1"}, {"GROUP", "64"}}, 64, false, true,
       "one work-group of 64 per row or column shares out the disparities, local memory", 1280},
      {"stereo_relaxation", "group64", {"direction.cl", "epipolar.cl", "stereo_relaxation.cl"},
       Form::items, {}, 64, true, true, "one work-item per left edge, groups of 64"},
      {"stereo_mutual", "group64", {"direction.cl", "epipolar.cl", "stereo_mutual.cl"}, Form::items, {}, 64, true, true,
       "one work-item per left edge, groups of 64"},
      {"point_index", "serial", {"indexed_points.cl", "point_index.cl"}, Form::items, {}, 1, true, false,
       "one work-item per side"},
      {"point_index", "items64", {"indexed_points.cl", "point_index_groups.cl"},
       Form::groups, {{"GROUP", "64"}}, 64, false, true, "one work-item per edge, then one per cell, groups of 64"},
      {"temporal_candidates", "lanes16", {"edge_positions.cl", "indexed_points.cl", "temporal_candidates.cl"},
       Form::items, {}, 16, true, true,
       "one work-item per previous stereo edge tests 16 points of the index at once, groups of 16"},
      {"temporal_match", "lanes16", {"described_edges.cl", "similarity.cl", "edge_positions.cl", "edge_groups.cl",
        "indexed_points.cl", "temporal_match.cl"},
       Form::items, {}, 1, true, false,
       "candidates, filters and choice of a row in one work-item, which tests 16 points of the index at once; "
       "groups of one"},
      {"temporal_match", "rows32", {"described_edges.cl", "similarity_lanes.cl", "edge_positions.cl",
        "edge_groups.cl", "indexed_points.cl", "temporal_match_groups.cl"},
       Form::groups, {{"GROUP", "32"}}, 32, false, true,
       "one work-group of 32 per row tests 32 points of the index at once, eight work-items compare a pair of "
       "patches; candidates in local memory", 5888},
      {"temporal_match", "lists", {}, Form::lists, {}, 64, false, false,
       "lists of candidates that one kernel after the other shortens"},
      {"temporal_quads", "group64", {"edge_positions.cl", "edge_groups.cl", "temporal_quads.cl"},
       Form::items, {}, 64, true, true, "one work-item per previous stereo edge, groups of 64"},
      {"wide_description", "group16", {"direction.cl", "wide_samples.cl", "wide_description.cl"},
       Form::items, {}, 16, true, false, "one work-item per stereo edge, groups of 16"},
      {"wide_description", "cells64", {"direction.cl", "wide_samples.cl", "wide_description_groups.cl"},
       Form::groups, {{"GROUP", "64"}}, 64, false, true,
       "sixteen work-items per stereo edge, one per cell, local memory, groups of 64", 7168},
      {"global_matching", "blocks", {"global_matching.cl"}, Form::items, {{"ROWS", "8"}}, 1, true, false,
       "one work-item per eight previous stereo edges, sixteen current ones as lanes"},
      {"global_matching", "tiles64", {"global_matching_tiles.cl"},
       Form::groups, {{"GROUP", "64"}, {"ROWS", "8"}}, 64, false, true,
       "one work-group of 64 per eight previous stereo edges, tiles of 64 current ones in local memory", 11264},
  };
  // clang-format on
  return table;
}

namespace {

/// A program of CPUs: the default variants of `stages`, and `files` that prepare their data.
struct Joint {
  std::vector<std::string> stages, files;
  Defines defines;

  /// Takes over what the table of variants says about the stages.
  Joint filled() const {
    Joint whole{stages, {}, {}};
    const auto add = [&](const std::string& file) {
      if (!whole.holds({file})) whole.files.push_back(file);
    };
    for (const auto& variant : all_variants()) {
      if (!variant.default_on_cpu || std::find(stages.begin(), stages.end(), variant.stage) == stages.end()) continue;
      for (const auto& file : variant.files) add(file);
      whole.defines.insert(variant.defines.begin(), variant.defines.end());
    }
    for (const auto& file : files) add(file);
    return whole;
  }
  bool holds(const std::vector<std::string>& wanted) const {
    return std::all_of(wanted.begin(), wanted.end(), [&](const std::string& file) {
      return std::find(files.begin(), files.end(), file) != files.end();
    });
  }
};

/// One program per kind of setting that the kernels depend on: the scale of the edges, the depth of the images, none. A
/// stage that is in no list has a program of its own. All files of a program see the defines of all its variants: what
/// is defined for one stage must not have a meaning in another's files.
const std::vector<Joint>& joint_programs() {
  static const std::vector<Joint> programs = [] {
    std::vector<Joint> list = {
        {{"edge_threshold", "edge_detection"}, {"edge_selection.cl"}, {}},
        {{"undistortion", "patches", "sift", "stereo_refinement", "coarse_disparity", "wide_description"},
         {"pixel_corners.cl"},
         {}},
        {{"scan", "stereo_candidates", "candidate_filters", "stereo_clusters", "stereo_relaxation", "stereo_mutual",
          "point_index", "temporal_candidates", "temporal_match", "temporal_quads", "global_matching"},
         {"edge_mask.cl"},
         {}},
    };
    for (Joint& joint : list) joint = joint.filled();
    return list;
  }();
  return programs;
}

const Variant& find_variant(const std::string& stage, const std::string& name) {
  std::string names, stages;
  for (const auto& variant : all_variants()) {
    if (variant.stage == stage && variant.name == name) return variant;
    if (variant.stage == stage) names += " " + variant.name;
    if (stages.find(" " + variant.stage) == std::string::npos) stages += " " + variant.stage;
  }
  if (names.empty()) throw UsageError("there is no stage '" + stage + "' with kernel variants; stages:" + stages);
  throw UsageError("stage '" + stage + "' has no variant '" + name + "'; variants:" + names);
}

[[noreturn]] void refuse(const Variant& variant, const Context& context) {
  throw DeviceError("variant " + variant.stage + "=" + variant.name + " wants groups of " +
                    std::to_string(variant.local_size) + " with " + std::to_string(variant.local_bytes) +
                    " bytes of local memory; " + context.name() + " has groups of up to " +
                    std::to_string(context.limits().group_items) + " and " +
                    std::to_string(context.limits().local_bytes) + " bytes");
}

}  // namespace

cl::Program joint_program(Context& context, const std::vector<std::string>& files, Defines defines) {
  if (context.is_cpu()) {
    for (const Joint& joint : joint_programs()) {
      if (!joint.holds(files)) continue;
      defines.insert(joint.defines.begin(), joint.defines.end());
      return context.program(joint.files, defines);
    }
  }
  return context.program(files, defines);
}

const Variant& choose_variant(const std::string& stage, const Context& context, const VariantChoice& chosen) {
  const auto fits = [&](const Variant& variant) {
    if (variant.form != Form::groups) return true;  // they can run in smaller groups
    return static_cast<std::size_t>(variant.local_size) <= context.limits().group_items &&
           static_cast<std::size_t>(variant.local_bytes) <= context.limits().local_bytes;
  };
  const auto wish = chosen.find(stage);
  if (wish != chosen.end()) {
    const Variant& variant = find_variant(stage, wish->second);
    if (!fits(variant)) refuse(variant, context);
    return variant;
  }
  const Variant* largest = nullptr;
  for (const auto& variant : all_variants()) {
    if (variant.stage != stage || !fits(variant)) continue;
    if (context.is_cpu() ? variant.default_on_cpu : variant.default_on_gpu) return variant;
    if (largest == nullptr || variant.local_size > largest->local_size) largest = &variant;
  }
  if (largest == nullptr) throw UsageError("stage '" + stage + "' has no variant that the device can run");
  return *largest;
}

void check_variants(const VariantChoice& chosen) {
  for (const auto& [stage, name] : chosen) find_variant(stage, name);
}

}  // namespace quadedge::opencl
