/// \file calibration_opencv.cpp  Results of OpenCV's stereoCalibrate as usually stored, in one file or in two
/// (intrinsics.yml, extrinsics.yml): M1 D1 M2 D2, and R T with x_right = R x_left + T. YAML, XML or JSON, as written by
/// cv::FileStorage. Optional: image_width and image_height; distortion_model: equidistant for results of
/// fisheye::stereoCalibrate.

#include <opencv2/core.hpp>
#include <opencv2/core/persistence.hpp>
#include <set>

#include "data/calibration_formats.hpp"
#include "data/layout.hpp"
#include "data/text.hpp"

namespace quadedge::data {
namespace {

constexpr const char* kExpected = "M1 D1 M2 D2 R T, as OpenCV's stereo calibration has them";

/// \throws DataError for a duplicate entry.
void check_keys(const cv::FileNode& root, const std::string& file) {
  std::set<std::string> keys;
  for (const std::string& key : root.keys())
    if (!keys.insert(key).second) fail(file, "a second entry " + key, "each entry once");
}

/// Files that are opened together; entries are looked up in all of them.
class Storage {
 public:
  explicit Storage(const std::vector<std::string>& files) : files_(files) {
    for (const auto& file : files) {
      const std::string text = read_text(file);
      try {
        opened_.emplace_back(text, cv::FileStorage::READ | cv::FileStorage::MEMORY);
        if (!opened_.back().isOpened() || !opened_.back().root().isMap()) fail(file, "no entries", kExpected);
        check_keys(opened_.back().root(), file);
      } catch (const cv::Exception& problem) {
        fail(file, "text that cv::FileStorage does not read (" + problem.err + ")", kExpected);
      }
    }
  }

  bool has(const std::string& key) const { return find(key).second != nullptr; }

  /// Returns a matrix of numbers as doubles. \throws DataError if the entry is not a matrix of finite numbers
  cv::Mat matrix(const std::string& key) const {
    const auto [node, file] = required(key);
    try {
      const cv::Mat matrix = node.mat();
      if (matrix.empty() || matrix.channels() != 1) fail(*file, "no matrix for " + key, "an opencv-matrix of numbers");
      cv::Mat doubles;
      matrix.convertTo(doubles, CV_64F);
      if (!cv::checkRange(doubles)) fail(*file, "a number that is not finite for " + key, "finite numbers");
      return doubles;
    } catch (const cv::Exception& problem) {
      fail(*file, "no matrix for " + key + " (" + problem.err + ")", "an opencv-matrix of numbers");
    }
  }
  cv::Mat matrix(const std::string& key, int rows, int columns) const {
    const cv::Mat found = matrix(key);
    if (found.rows != rows || found.cols != columns) complain_size(key, found, rows, columns);
    return found;
  }
  std::string word(const std::string& key) const {
    const cv::FileNode node = find(key).first;
    return node.isString() ? node.string() : std::string();
  }
  int side(const std::string& key) const {
    const auto [node, file] = required(key);
    const double value = node.isReal() || node.isInt() ? node.real() : 0;
    if (!(value >= 1 && value <= kLargestImageSide) || value != std::floor(value))
      fail(*file, format_exact(value) + " for " + key, "a whole number of pixels");
    return static_cast<int>(value);
  }
  const std::string& file_of(const std::string& key) const { return *required(key).second; }

  [[noreturn]] void complain_size(const std::string& key, const cv::Mat& found, int rows, int columns) const {
    fail(file_of(key), "a matrix of " + std::to_string(found.rows) + " x " + std::to_string(found.cols) + " for " + key,
         std::to_string(rows) + " x " + std::to_string(columns));
  }

 private:
  using Place = std::pair<cv::FileNode, const std::string*>;

  Place find(const std::string& key) const {
    for (std::size_t i = 0; i < opened_.size(); ++i) {
      const cv::FileNode node = opened_[i][key];
      if (!node.empty()) return {node, &files_[i]};
    }
    return {{}, nullptr};
  }
  Place required(const std::string& key) const {
    const Place place = find(key);
    if (place.second != nullptr) return place;
    std::string all;
    for (const auto& file : files_) all += (all.empty() ? "" : ", ") + file;
    fail(all, "no entry " + key, kExpected);
  }

  std::vector<std::string> files_;
  std::vector<cv::FileStorage> opened_;
};

Lens read_lens(const Storage& storage, const std::string& number) {
  const cv::Mat k = storage.matrix("M" + number, 3, 3), d = storage.matrix("D" + number);
  if (d.rows != 1 && d.cols != 1) storage.complain_size("D" + number, d, 1, 5);
  Lens lens;
  const std::string word = storage.word("distortion_model");
  if (word == "equidistant" || word == "fisheye") lens.model = LensModel::equidistant;
  lens.camera = {k.at<double>(0, 0), k.at<double>(1, 1), k.at<double>(0, 2), k.at<double>(1, 2), 0, 0};
  lens.parameters.assign(d.begin<double>(), d.end<double>());
  if (storage.has("image_width")) {
    lens.camera.width = storage.side("image_width");
    lens.camera.height = storage.side("image_height");
  }
  check_lens(lens, storage.file_of("M" + number), "M" + number, "D" + number);
  return lens;
}

/// Reads a 3 x 3 matrix or a rotation vector [rad].
Eigen::Matrix3d read_rotation(const Storage& storage) {
  const cv::Mat r = storage.matrix("R");
  const std::string where = storage.file_of("R") + " (R)";
  if (r.total() == 3) {
    const Eigen::Vector3d vector(r.begin<double>()[0], r.begin<double>()[1], r.begin<double>()[2]);
    return rotation_of_vector(vector, where);
  }
  if (r.rows != 3 || r.cols != 3) storage.complain_size("R", r, 3, 3);
  return nearest_rotation(Eigen::Map<const Eigen::Matrix3d>(r.ptr<double>()).transpose(), where);
}

}  // namespace

StereoCalibration read_opencv_calibration(const std::vector<std::string>& files) {
  const Storage storage(files);
  StereoCalibration calibration;
  calibration.left = read_lens(storage, "1");
  calibration.right = read_lens(storage, "2");
  calibration.right_from_left.linear() = read_rotation(storage);
  const cv::Mat t = storage.matrix("T");
  if (t.total() != 3) storage.complain_size("T", t, 3, 1);
  calibration.right_from_left.translation() << t.begin<double>()[0], t.begin<double>()[1], t.begin<double>()[2];
  return calibration;
}

}  // namespace quadedge::data
