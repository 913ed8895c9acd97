#pragma once
/// \file image_list.hpp  The images of a folder in order, and the times that stand beside them.

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace quadedge::data {

/// Rows of EuRoC's data.csv: stamp and name of an image. \throws DataError for a stamp that stands twice and for a name
/// that leads to another folder.
std::vector<std::pair<std::int64_t, std::string>> read_image_list(const std::string& file);

/// Stamps [ns] of a file with a row per frame: seconds, or as EuRoC's data.csv, where the name ends in .csv. In the
/// file's order. \throws DataError.
std::vector<std::int64_t> read_times(const std::string& file);

/// The images of one camera.
struct CameraImages {
  std::vector<std::string> files;
  std::vector<std::int64_t> stamps_ns;  ///< one per file; empty where nothing tells them
  std::string stamps_from;              ///< what told them, for messages
};

/// Every image in a folder in natural order of the names ("img9" before "img10"). Stamps come from data.csv (then only
/// the images that it lists count, in its order) or times.txt, in the folder or the one above it; or else from the
/// names, where every one is a number that can be a time: with a decimal point seconds, of 19 digits nanoseconds, of 16
/// microseconds, of 13 milliseconds. \throws DataError for a folder without images, a list that names a missing one, a
/// times.txt of another length.
CameraImages list_images(const std::filesystem::path& folder);

/// Whether digits in the names are compared as numbers: "img9" comes before "img10".
bool comes_before(const std::string& a, const std::string& b);

}  // namespace quadedge::data
