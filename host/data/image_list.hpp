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

/// Timestamps [ns] of a file with one row per frame, in its order: seconds, or EuRoC's format if the name ends in .csv.
/// \throws DataError
std::vector<std::int64_t> read_times(const std::string& file);

/// The images of one camera.
struct CameraImages {
  std::vector<std::string> files;
  std::vector<std::int64_t> stamps_ns;  ///< one per file; empty if unknown
  std::string stamps_from;              ///< where they come from, for messages
};

/// All images of a folder in natural order of their names ("img9" before "img10"). Timestamps come from data.csv (in
/// which case only the listed images are used, in its order) or times.txt, in the folder or its parent; otherwise from
/// the names, if every name is a plausible time: seconds with a decimal point, or integer nanoseconds (19 digits),
/// microseconds (16) or milliseconds (13). \throws DataError for a folder without images, a list with a missing image,
/// or a times.txt of another length
CameraImages list_images(const std::filesystem::path& folder);

/// Median period of timestamps [ns]; 0 for fewer than two.
std::int64_t usual_period(const std::vector<std::int64_t>& stamps_ns);

/// Natural order: digits in names are compared as numbers.
bool comes_before(const std::string& a, const std::string& b);

}  // namespace quadedge::data
