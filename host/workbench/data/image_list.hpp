#pragma once
/// \file image_list.hpp  The images of a folder in order, with their timestamps: unit, order and rate.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace quadedge::data {

// Timestamps from file names and text files: their unit, order and rate.

/// Timestamps [ns] that names state, if all of them do: seconds with a decimal point, or integers of ten digits or more
/// without a leading zero. The unit of integers (ns, us or ms) is the one that gives a plausible rate; where several
/// do, or for a single name, 19 digits are ns, 16 us and 13 ms. \throws DataError for a number out of range
std::optional<std::vector<std::int64_t>> stamps_of_names(const std::vector<std::string>& stems,
                                                         const std::string& folder);

/// Indices of left and right timestamps that are mutually nearest.
struct StampPairs {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;  ///< in the order of the left timestamps
  std::int64_t largest_difference_ns = 0;
};

/// \param tolerance_ns largest difference of a pair; 0: less than half the usual period of the left timestamps, or any
/// for a single one
StampPairs pair_stamps(const std::vector<std::int64_t>& left_ns, const std::vector<std::int64_t>& right_ns,
                       std::int64_t tolerance_ns = 0);

/// Median period of timestamps [ns]; 0 for fewer than two.
std::int64_t usual_period(const std::vector<std::int64_t>& stamps_ns);

/// A warning for a rate outside 0.2 to 1000 Hz, which suggests another unit; empty otherwise.
std::string rate_complaint(const std::vector<std::int64_t>& stamps_ns);

/// A warning for images in order of which one number is further from the last than twice the usual step; empty
/// otherwise, and for names without numbers.
std::string number_jump(const std::vector<std::string>& files);

/// Rows of EuRoC's data.csv: timestamp and image name. \throws DataError for a duplicate timestamp and for a name that
/// refers to another folder
std::vector<std::pair<std::int64_t, std::string>> read_image_list(const std::string& file);

/// Timestamps [ns] of a file with one row per frame, in its order: seconds; integers as stamps_of_names(); "name
/// seconds exposure" as DSO and TUM-VI write it; a date and time as KITTI's raw drives have them; or EuRoC's format if
/// the name ends in .csv. \throws DataError for other rows, for stamps that repeat, and unless `restarts` for stamps
/// that go back
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
