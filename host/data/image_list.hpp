#pragma once
/// \file image_list.hpp  The images of a folder in order, with their timestamps.

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace quadedge::data {

/// Rows of EuRoC's data.csv: timestamp and image name. \throws DataError for a duplicate timestamp and for a name that
/// refers to another folder
std::vector<std::pair<std::int64_t, std::string>> read_image_list(const std::string& file);

/// Timestamps [ns] of a file with one row per frame, in its order: read_time_rows(), or EuRoC's format if the name ends
/// in .csv. \throws DataError
std::vector<std::int64_t> read_times(const std::string& file, bool restarts = false);

/// The images of one camera.
struct CameraImages {
  std::vector<std::string> files;
  std::vector<std::int64_t> stamps_ns;  ///< one per file; empty if unknown
  std::string stamps_from;              ///< where they come from, for messages
};

/// All images of a folder in natural order of their names ("img9" before "img10"). Timestamps come from data.csv (in
/// which case only the listed images are used, in its order) or times.txt, in the folder or its parent; otherwise from
/// the names (stamps_of_names()). Without `needs_stamps` none of them is opened. \throws DataError for a folder without
/// images, a list with a missing image, or a times.txt of another length
CameraImages list_images(const std::filesystem::path& folder, bool needs_stamps = true);

/// Natural order: digits in names are compared as numbers.
bool comes_before(const std::string& a, const std::string& b);

}  // namespace quadedge::data
