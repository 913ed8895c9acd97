/// \file matlab.cpp  MATLAB's stereoParameters as text, as displayed, assigned or by jsonencode(toStruct(...)):
/// CameraParameters1 and CameraParameters2 with IntrinsicMatrix (the transpose of K) or K, RadialDistortion,
/// TangentialDistortion, ImageSize (rows, columns); RotationOfCamera2 for row vectors and TranslationOfCamera2, or
/// PoseCamera2 (R, Translation); WorldUnits, millimetres by default. Pixels count from 1.

#include <cctype>
#include <charconv>
#include <map>

#include "data/calibrations/forms.hpp"
#include "data/text.hpp"

namespace quadedge::data {
namespace {

bool is_of_word(char letter) { return std::isalnum(static_cast<unsigned char>(letter)) != 0 || letter == '_'; }

/// The numbers behind every name: "1.K" of CameraParameters1, "2.K" of CameraParameters2, and "K" of the last one.
class Numbers {
 public:
  explicit Numbers(const CalibrationText& text) : file_(text.file) {
    const std::string& all = text.text;
    std::string camera, name;
    double scale = 1;  // of a matrix that is displayed as "1.0e+03 *" and its rows
    bool is_new = true;
    for (std::size_t at = 0; at < all.size();) {
      const std::size_t begin = at;
      if (std::isalpha(static_cast<unsigned char>(all[at])) != 0) {
        while (at < all.size() && is_of_word(all[at])) ++at;
        const std::string word = all.substr(begin, at - begin);
        if (name == "WorldUnits") unit_ = word;
        if (word == "CameraParameters1" || word == "CameraParameters2") camera = word.back() + std::string(".");
        if (word != "ans") name = word;
        is_new = true;
        scale = 1;
        continue;
      }
      double value = 0;
      const auto end = std::from_chars(all.data() + at, all.data() + all.size(), value);
      if (end.ec != std::errc()) {
        ++at;
      } else {
        at = static_cast<std::size_t>(end.ptr - all.data());
        const std::size_t next = all.find_first_not_of(' ', at);
        if (next != std::string::npos && all[next] == '*') {
          scale = value;
          continue;
        }
        for (const std::string& key : {camera + name, name}) {
          if (is_new) values_[key].clear();
          values_[key].push_back(scale * value);
        }
        is_new = false;
      }
    }
  }

  /// Empty if there are none.
  std::vector<double> of(const std::string& name) const {
    const auto found = values_.find(name);
    return found == values_.end() ? std::vector<double>() : found->second;
  }
  /// The numbers of the first of the names that has `count` of them. \throws DataError if none does
  std::vector<double> of_first(std::initializer_list<std::string> names, std::size_t count) const {
    for (const std::string& name : names)
      if (auto values = of(name); values.size() == count) return values;
    fail(file_, "no " + std::to_string(count) + " numbers for " + *names.begin(),
         "the values of stereoParameters, not a summary, such as by jsonencode(toStruct(stereoParams))");
  }
  double metres() const {
    constexpr std::pair<const char*, double> kUnits[] = {{"mm", 1e-3},    {"milli", 1e-3}, {"cm", 1e-2},
                                                         {"centi", 1e-2}, {"in", 0.0254},  {"m", 1}};
    for (const auto& [name, metres] : kUnits)
      if (unit_.rfind(name, 0) == 0) return metres;
    fail(file_, "WorldUnits " + in_quotes(unit_), "mm, cm, m or in");
  }

 private:
  std::string file_, unit_ = "mm";
  std::map<std::string, std::vector<double>> values_;
};

StatedLens read_lens(const CalibrationText& text, const Numbers& numbers, const std::string& camera) {
  auto k = numbers.of_first({camera + "IntrinsicMatrix", camera + "K"}, 9);
  if (k[6] != 0) k = {k[0], k[3], k[6], k[1], k[4], k[7], k[2], k[5], k[8]};
  constexpr double kFirstPixel = 1;
  StatedLens stated(text.file, camera + "IntrinsicMatrix", camera + "RadialDistortion",
                    {k[0], k[4], k[2] - kFirstPixel, k[5] - kFirstPixel});
  if (k[1] != 0) fail(text.file, "a skew of " + format_exact(k[1]), "0: estimate the calibration without skew");
  if (const auto size = numbers.of(camera + "ImageSize"); size.size() == 2)
    set_size(stated.lens.camera, {static_cast<int>(size[1]), static_cast<int>(size[0])});
  auto radial = numbers.of(camera + "RadialDistortion"), tangential = numbers.of(camera + "TangentialDistortion");
  if (radial.size() != 3) radial = numbers.of_first({camera + "RadialDistortion"}, 2);
  radial.resize(3);
  tangential.resize(2);
  stated.lens.parameters = {radial[0], radial[1], tangential[0], tangential[1], radial[2]};
  return stated;
}

bool is_matlab(const CalibrationText& text) {
  const auto has = [&](const char* name) { return text.text.find(name) != std::string::npos; };
  return has("CameraParameters1") && (has("TranslationOfCamera2") || has("PoseCamera2"));
}

StatedCalibration read_matlab(const std::vector<CalibrationText>& texts) {
  const CalibrationText& text = texts[0];
  const Numbers numbers(text);
  StatedCalibration stated;
  stated.left = read_lens(text, numbers, "1.");
  stated.right = read_lens(text, numbers, "2.");
  // Column by column, the transpose: MATLAB multiplies row vectors from the left by RotationOfCamera2, not by R.
  const auto rows = numbers.of("RotationOfCamera2"), r = rows.size() == 9 ? rows : numbers.of_first({"R"}, 9),
             t = numbers.of_first({"TranslationOfCamera2", "Translation"}, 3);
  stated.right_from_left.linear() = Eigen::Map<const Eigen::Matrix3d>(r.data());
  if (rows.size() != 9) stated.right_from_left.linear().transposeInPlace();
  stated.right_from_left.translation() = numbers.metres() * Eigen::Vector3d(t[0], t[1], t[2]);
  return stated;
}

}  // namespace

const CalibrationForm kMatlab{"matlab", "MATLAB's stereoParameters as text (CameraParameters1, TranslationOfCamera2)",
                              false, is_matlab, read_matlab};

}  // namespace quadedge::data
