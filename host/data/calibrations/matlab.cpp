/// \file matlab.cpp  MATLAB's stereoParameters as text: CameraParameters1 and CameraParameters2 with IntrinsicMatrix
/// (the transpose of K) or K, RadialDistortion, TangentialDistortion, ImageSize (rows, columns); RotationOfCamera2 for
/// row vectors, TranslationOfCamera2 [mm]. Pixels count from 1.

#include "data/calibrations/forms.hpp"
#include "data/text.hpp"

namespace quadedge::data {
namespace {

/// The numbers behind a name, up to the next letter; empty if the text does not have the name.
std::vector<double> numbers_after(const CalibrationText& text, const std::string& name, std::size_t from,
                                  std::size_t to) {
  std::size_t at = text.text.find(name, from);
  while (at != std::string::npos && at < to && std::isalnum(static_cast<unsigned char>(text.text[at + name.size()])))
    at = text.text.find(name, at + 1);
  if (at == std::string::npos || at >= to) return {};
  std::vector<double> values;
  const int line = 1 + static_cast<int>(std::count(text.text.begin(), text.text.begin() + static_cast<long>(at), '\n'));
  const std::size_t end =
      text.text.find_first_of("ABCDFGHIJKLMNOPQRSTUVWXYZabcdfghijklmnopqrstuvwxyz", at + name.size());
  for (const std::string& token :
       split(std::string_view(text.text).substr(at + name.size(), end - at - name.size()), " \t\r\n:=[](),;'\""))
    values.push_back(parse_number(token, text.file, line, name));
  return values;
}

std::vector<double> required(const CalibrationText& text, const std::string& name, std::size_t from, std::size_t to,
                             std::size_t count) {
  auto values = numbers_after(text, name, from, to);
  if (values.size() != count)
    fail(text.file, counted(values.size(), "number") + " for " + name, std::to_string(count) + ", row by row");
  return values;
}

StatedLens read_lens(const CalibrationText& text, std::size_t from, std::size_t to) {
  StatedLens stated(text.file, "IntrinsicMatrix", "RadialDistortion");
  Lens& lens = stated.lens;
  const bool is_transposed = !numbers_after(text, "IntrinsicMatrix", from, to).empty();
  const auto k = required(text, is_transposed ? "IntrinsicMatrix" : "K", from, to, 9);
  constexpr double kFirstPixel = 1;
  lens.camera.fx = k[0];
  lens.camera.fy = k[4];
  lens.camera.cx = (is_transposed ? k[6] : k[2]) - kFirstPixel;
  lens.camera.cy = (is_transposed ? k[7] : k[5]) - kFirstPixel;
  if (const double skew = is_transposed ? k[3] : k[1]; skew != 0)
    fail(text.file, "a skew of " + format_exact(skew), "0: estimate the calibration without skew");
  if (const auto size = numbers_after(text, "ImageSize", from, to); size.size() == 2) {
    lens.camera.width = static_cast<int>(size[1]);
    lens.camera.height = static_cast<int>(size[0]);
  }
  auto radial = numbers_after(text, "RadialDistortion", from, to),
       tangential = numbers_after(text, "TangentialDistortion", from, to);
  radial.resize(3);
  tangential.resize(2);
  lens.parameters = {radial[0], radial[1], tangential[0], tangential[1], radial[2]};
  return stated;
}

}  // namespace

bool is_matlab(const CalibrationText& text) { return text.text.find("TranslationOfCamera2") != std::string::npos; }

StatedCalibration read_matlab(const CalibrationText& text) {
  const std::size_t all = text.text.size(), first = text.text.find("CameraParameters1"),
                    second = text.text.find("CameraParameters2");
  if (first == std::string::npos || second == std::string::npos || second < first)
    fail(text.file, "no CameraParameters1 and CameraParameters2", "MATLAB's stereoParameters");
  StatedCalibration stated;
  stated.left = read_lens(text, first, second);
  stated.right = read_lens(text, second, all);
  const auto r = required(text, "RotationOfCamera2", 0, all, 9), t = required(text, "TranslationOfCamera2", 0, all, 3);
  constexpr double kMetres = 1e-3;  // MATLAB's calibrator works in millimetres
  // Column by column, the transpose: MATLAB multiplies row vectors from the left.
  stated.right_from_left.linear() = Eigen::Map<const Eigen::Matrix3d>(r.data());
  stated.right_from_left.translation() = kMetres * Eigen::Vector3d(t[0], t[1], t[2]);
  return stated;
}

}  // namespace quadedge::data
