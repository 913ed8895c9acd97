/// \file point_cloud_files.cpp  Edges in space as files: PLY, and COLMAP's text files.

#include <cmath>
#include <cstdint>
#include <cstring>

#include "common/printed.hpp"
#include "data/atomic_file.hpp"
#include "data/text.hpp"
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

constexpr double kCorner = 0.5;  // px from a pixel's corner to its centre

std::string camera_row(int id, const PinholeCamera& camera) {
  std::string row =
      std::to_string(id) + " PINHOLE " + std::to_string(camera.width) + " " + std::to_string(camera.height);
  for (const double value : {camera.fx, camera.fy, camera.cx + kCorner, camera.cy + kCorner})
    row += " " + data::format_exact(value);
  return row + "\n";
}

/// The first line of an image.
std::string image_row(int id, const Eigen::Isometry3d& camera_from_world, int camera, const std::string& name) {
  const Eigen::Quaterniond q(camera_from_world.linear());
  const Eigen::Vector3d t = camera_from_world.translation();
  std::string row = std::to_string(id);
  for (const double value : {q.w(), q.x(), q.y(), q.z(), t.x(), t.y(), t.z()}) row += " " + data::format_exact(value);
  return row + " " + std::to_string(camera) + " " + name + "\n";
}

std::string image_name(const char* side, int frame) { return printed("%s_%06d.png", side, frame); }

int left_image(std::size_t view) { return 2 * static_cast<int>(view) + 1; }

/// A point in an image: its place, and which point it is.
struct Place {
  float x, y;
  std::size_t point;
};

std::string images_text(const StereoRig& rig, const std::vector<CloudView>& views,
                        const std::vector<std::vector<Place>>& places) {
  std::string text = "# IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME, then POINTS2D[] as X Y POINT3D_ID\n";
  for (std::size_t v = 0; v < views.size(); ++v) {
    const Eigen::Isometry3d left_from_world = views[v].world_from_left.inverse();
    text += image_row(left_image(v), left_from_world, 1, image_name("left", views[v].frame));
    for (const Place& place : places[v]) {
      text += printed("%.4f %.4f %zu ", static_cast<double>(place.x) + kCorner, static_cast<double>(place.y) + kCorner,
                      place.point + 1);
    }
    text += "\n" +
            image_row(left_image(v) + 1, rig.right_from_left * left_from_world, 2, image_name("right", views[v].frame));
    text += '\n';
  }
  return text;
}

/// Mean distance of a point from where it was seen [px].
double reprojection_error(const StereoRig& rig, const std::vector<CloudView>& views, const CloudPoint& point,
                          const std::vector<CloudSighting>& sightings) {
  double sum = 0;
  for (const auto& seen : sightings) {
    const Eigen::Vector3d at = views[static_cast<std::size_t>(seen.view)].world_from_left.inverse() * point.position;
    sum += (rig.left.project(at) - Eigen::Vector2d(seen.x, seen.y)).norm();
  }
  return sightings.empty() ? 0 : sum / static_cast<double>(sightings.size());
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

// Points as COLMAP's text files. COLMAP counts pixels from the corner of the top-left one, whose centre is (0.5, 0.5)
// there; poses are camera_from_world, quaternions w x y z.

void write_colmap(const std::string& folder, const StereoRig& rig, const PointCloud& cloud) {
  data::make_folder(folder);
  const auto points = cloud.points();
  const auto sightings = cloud.sightings();
  std::vector<std::vector<Place>> places(cloud.views().size());
  std::string text = "# POINT3D_ID X Y Z R G B ERROR TRACK[] as IMAGE_ID POINT2D_IDX\n";
  for (std::size_t i = 0; i < points.size(); ++i) {
    const CloudPoint& point = points[i];
    text += std::to_string(i + 1);
    for (int k = 0; k < 3; ++k) text += " " + data::format_exact(point.position[k]);
    const std::string grey = " " + std::to_string(std::lround(point.grey));
    text += grey + grey + grey;
    static const std::vector<CloudSighting> none;
    const auto& seen = sightings.empty() ? none : sightings[i];
    text += " " + data::format_exact(reprojection_error(rig, cloud.views(), point, seen));
    for (const auto& sighting : seen) {
      auto& in_image = places[static_cast<std::size_t>(sighting.view)];
      text += " " + std::to_string(left_image(static_cast<std::size_t>(sighting.view))) + " " +
              std::to_string(in_image.size());
      in_image.push_back({sighting.x, sighting.y, i});
    }
    text += '\n';
  }
  data::write_atomically(folder + "/cameras.txt", "# CAMERA_ID MODEL WIDTH HEIGHT PARAMS[]\n" +
                                                      camera_row(1, rig.left) + camera_row(2, rig.right));
  data::write_atomically(folder + "/images.txt", images_text(rig, cloud.views(), places));
  data::write_atomically(folder + "/points3D.txt", text);
}

}  // namespace quadedge
