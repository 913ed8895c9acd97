#pragma once
/// \file saved_map.hpp  The places of a map, for going back to them: in memory and as a file.

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "quadedge/camera.hpp"

namespace quadedge {

namespace map {
struct Place;
struct SavedPlaces;
}  // namespace map

/// Key stereo rigs with their poses in the frame of a map, and the cameras that recorded them. Copies share the rigs.
/// Map::saved() makes one, Localiser locates frames in it.
class SavedMap {
 public:
  /// \param header everything but the places \param places in the order of the header's poses
  SavedMap(map::SavedPlaces header, std::vector<map::Place> places);

  std::size_t key_rigs() const;
  /// The pinhole cameras of the recording, without undistortion tables.
  const StereoRig& rig() const;
  /// Whether the recorded images had lens distortion: then rig() does not describe further images of these cameras.
  bool is_undistorted() const;
  /// The contents of a map file without its header (doc/method.md section 10).
  std::string bytes() const;
  /// \param source name for messages \throws DataError for anything that bytes() does not write
  static SavedMap from_bytes(std::string_view bytes, const std::string& source);

  const map::SavedPlaces& places() const { return *places_; }

 private:
  std::shared_ptr<const map::SavedPlaces> places_;
};

/// Writes a map file, completely or not at all. \throws DataError if it cannot be written, or would have more than 2
/// GiB, which read_map() refuses (`map.max_memory_mb` limits it)
void write_map(const std::string& file, const SavedMap& map);

/// \throws DataError that names the file, what was found and what was expected, for a file that is missing, damaged,
/// cut, of another kind, or of another version of the format
SavedMap read_map(const std::string& file);

}  // namespace quadedge
