/// \file point_cloud_files.cpp  Edges in space as a PLY file.

#include <cmath>
#include <cstdint>
#include <cstring>

#include "data/atomic_file.hpp"
#include "quadedge/point_cloud.hpp"

namespace quadedge {
namespace {

/// Appends a value as little-endian bytes, which all machines that OpenCL runs on have.
template <class T>
void append(std::string& bytes, T value) {
  char raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);
  bytes.append(raw, sizeof raw);
}

}  // namespace

void write_ply(const std::string& file, const std::vector<CloudPoint>& points) {
  std::string bytes = "ply\nformat binary_little_endian 1.0\ncomment edges in space, metres\nelement vertex " +
                      std::to_string(points.size()) + "\n";
  for (const char* name : {"x", "y", "z"}) bytes += std::string("property double ") + name + "\n";
  for (const char* name : {"tangent_x", "tangent_y", "tangent_z", "grey", "sigma"})
    bytes += std::string("property float ") + name + "\n";
  bytes += "property int views\n";
  for (const char* name : {"red", "green", "blue"}) bytes += std::string("property uchar ") + name + "\n";
  bytes += "end_header\n";
  for (const auto& point : points) {
    for (int i = 0; i < 3; ++i) append(bytes, point.position[i]);
    for (int i = 0; i < 3; ++i) append(bytes, point.tangent[i]);
    append(bytes, point.grey);
    append(bytes, point.sigma);
    append(bytes, static_cast<std::int32_t>(point.views));
    for (int i = 0; i < 3; ++i) append(bytes, static_cast<std::uint8_t>(std::lround(point.grey)));
  }
  data::write_atomically(file, bytes);
}

}  // namespace quadedge
