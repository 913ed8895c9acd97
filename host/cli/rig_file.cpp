/// \file rig_file.cpp  Stores learned sums as TOML beside the calibration that they belong to; compares it on reading.
#include "cli/rig_file.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <vector>

#include "data/atomic_file.hpp"
#include "data/toml_file.hpp"
#include "geometry/calibration.hpp"
#include "motion/latest_frame.hpp"
#include "quadedge/error.hpp"

namespace quadedge::cli {
namespace {

using Numbers = std::vector<double>;
constexpr const char *kOffset = "pose.disparity_offset", *kSigma = "pose.disparity_offset_sigma";

std::string line(const std::string& key, const std::string& value) { return key + " = " + value + "\n"; }

Numbers numbers_of(const PinholeCamera& camera) {
  return {static_cast<double>(camera.width),
          static_cast<double>(camera.height),
          camera.fx,
          camera.fy,
          camera.cx,
          camera.cy};
}

template <class Matrix>
Numbers numbers_of(const Matrix& matrix) {
  return Numbers(matrix.data(), matrix.data() + matrix.size());
}

/// The calibration by which a file is known, under the keys of the file.
std::map<std::string, Numbers> cameras_of(const StereoRig& rig) {
  Numbers pose = numbers_of(rounded_rotation(rig.right_from_left));
  for (const double value : numbers_of(rounded(rig.right_from_left.translation()))) pose.push_back(value);
  return {{"left", numbers_of(rig.left)}, {"right", numbers_of(rig.right)}, {"right_from_left", pose}};
}

std::map<std::string, Numbers> rows_of(const rig::RowModel::Sums& sums) {
  return {{"rows.normal", numbers_of(sums.normal)},
          {"rows.right_side", numbers_of(sums.right_side)},
          {"rows.shared", numbers_of(sums.shared)},
          {"rows.sums", {sums.frames, sums.variance, sums.whole_variance}}};
}

/// What is wrong in a configuration is how it is used; the content of this file is data.
template <class Read>
auto from_file(const Read& read) {
  try {
    return read();
  } catch (const UsageError& error) {
    throw DataError(error.what());
  }
}

bool is_same(double one, double other) { return std::abs(one - other) <= 1e-6 * std::max(1e-3, std::abs(other)); }

}  // namespace

RigFile::RigFile(const std::string& name, const StereoRig& rig) : name_(name), cameras_(cameras_of(rig)) {
  std::error_code unreadable;  // reading it says why
  if (!std::filesystem::exists(name, unreadable) && !unreadable) return;
  std::map<std::string, Numbers> found = cameras_, rows = rows_of({});
  found.merge(rows);
  std::size_t known = 0, offsets = 0;
  const auto entries = from_file([&] { return data::read_toml(name); });
  for (const auto& entry : entries) {
    const bool is_offset = entry.key == kOffset || entry.key == kSigma;
    known += found.count(entry.key);
    offsets += is_offset ? 1 : 0;
    if (is_offset) offset_ += line(entry.key, entry.found);
  }
  const bool is_of_release_0_1 = known == 0 && offsets == 2;  // the offset alone
  if (known + offsets != entries.size() || (known != found.size() && !is_of_release_0_1) || offsets % 2 != 0)
    throw DataError(name + ": found another file, expected one that an earlier run with --rig-file has written");
  if (is_of_release_0_1) return;
  for (const auto& entry : entries)
    if (found.count(entry.key) > 0) from_file([&] { data::assign(entry, found[entry.key]); });
  for (const auto& [key, expected] : cameras_) {
    if (!std::equal(expected.begin(), expected.end(), found[key].begin(), is_same))
      throw DataError(name + ": learned with another calibration: found " + key + " = " + data::toml_text(found[key]) +
                      ", expected " + data::toml_text(expected));
  }
  sums_.frames = found["rows.sums"][0];
  sums_.variance = found["rows.sums"][1];
  sums_.whole_variance = found["rows.sums"][2];
  sums_.normal = Eigen::Map<rig::RowModel::Normal>(found["rows.normal"].data());
  sums_.shared = Eigen::Map<rig::RowModel::Normal>(found["rows.shared"].data());
  sums_.right_side = Eigen::Map<rig::RowModel::Terms>(found["rows.right_side"].data());
  const bool is_sound = sums_.frames == 0 || (sums_.frames > 0 && sums_.normal.llt().info() == Eigen::Success);
  if (!is_sound || sums_.variance < 0 || sums_.whole_variance < 0 || sums_.shared.diagonal().minCoeff() < 0)
    throw DataError(name + ": found a row model that no run has written, expected positive variances");
}

Config RigFile::with_offset(const Config& config) const {
  return from_file([&] { return read_config_text(offset_, name_, config); });
}

void RigFile::start(const StereoOdometry& odometry) const {
  odometry::LatestFrame::of(odometry).rows.start_from(sums_);
}

void RigFile::learn(const StereoOdometry& odometry, const FrameResult& result) {
  sums_ = odometry::LatestFrame::of(odometry).rows.rows().sums();
  if (!(result.rig.disparity_offset_sigma > 0)) return;
  offset_ = line(kOffset, data::toml_text(result.rig.disparity_offset)) +
            line(kSigma, data::toml_text(result.rig.disparity_offset_sigma));
}

void RigFile::write() const {
  if (name_.empty() || (sums_.frames == 0 && offset_.empty())) return;
  std::string text = "# What `quadedge run --rig-file` has learned of a stereo rig\n";
  for (const auto& [key, numbers] : cameras_) text += line(key, data::toml_text(numbers));
  text += offset_;
  for (const auto& [key, numbers] : rows_of(sums_)) text += line(key, data::toml_text(numbers));
  data::write_atomically(name_, text);
}

}  // namespace quadedge::cli
