#pragma once
/// \file frames_csv.hpp  frames.csv: status, counts and times of every input frame.

#include "report/frame_rows.hpp"

namespace quadedge::report {

/// The columns of frames.csv: frame, stamp_s, status, segment, key_rig, new_key_rig, edge_threshold, disparity_range,
/// the counts, matched_ratio, epipolar_residual, moving_ratio, ambiguous_motion, latency_ms, one NAME_ms per stage of
/// kHostStages, warning, message. Fields without a value are empty.
const FrameColumns& frames_csv_columns();

/// \throws DataError for a missing or damaged file.
CsvTable read_frames_csv(const std::string& file);

}  // namespace quadedge::report
