#pragma once
/// \file stamps.hpp  Timestamps from file names and text files: their unit, order and rate.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace quadedge::data {

/// Timestamps [ns] that names state, if all of them do: seconds with a decimal point, or integers of ten digits or more
/// without a leading zero. The unit of integers (ns, us or ms) is the one that gives a plausible rate; where several
/// do, or for a single name, 19 digits are ns, 16 us and 13 ms. \throws DataError for a number out of range
std::optional<std::vector<std::int64_t>> stamps_of_names(const std::vector<std::string>& stems,
                                                         const std::string& folder);

/// The rows of a file of times.
struct TimeRows {
  std::vector<std::int64_t> stamps_ns;
  std::vector<std::string> names;  ///< image names without extension, one per row; empty if the rows state none
};

/// Reads one row per frame: seconds; integers as stamps_of_names(); "name seconds exposure" as DSO and TUM-VI write it;
/// a date and time as KITTI's raw drives have them. \throws DataError for other rows and for stamps that do not
/// increase
TimeRows read_time_rows(const std::string& file);

/// Median period of timestamps [ns]; 0 for fewer than two.
std::int64_t usual_period(const std::vector<std::int64_t>& stamps_ns);

/// A warning for a rate outside 0.2 to 1000 Hz, which suggests another unit; empty otherwise.
std::string rate_complaint(const std::vector<std::int64_t>& stamps_ns);

}  // namespace quadedge::data
