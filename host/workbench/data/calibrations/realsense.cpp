/// \file realsense.cpp  What `rs-enumerate-devices -c` prints of a RealSense camera: intrinsics of every stream and
/// resolution, and the extrinsics between streams, which map points from one to the other [m]. The stereo pair is
/// Infrared 1 and 2, or Fisheye 1 and 2.

#include <algorithm>

#include "data/calibrations/forms.hpp"
#include "data/text.hpp"

namespace quadedge::data {
namespace {

std::string after_colon(const std::string& line) { return line.substr(line.find(':') + 1); }

std::vector<double> numbers_in(const std::string& text, const std::string& file, int line) {
  std::vector<double> values;
  for (const std::string& token : split(text, " \t\r")) values.push_back(parse_number(token, file, line, "numbers"));
  return values;
}

/// The camera with the image size of another one.
std::vector<StatedLens>::const_iterator of_size(const std::vector<StatedLens>& cameras, const StatedLens& other) {
  return std::find_if(cameras.begin(), cameras.end(), [&](const StatedLens& camera) {
    return size_of(camera.lens.camera) == size_of(other.lens.camera);
  });
}

/// The cameras of a stream, one per resolution.
std::vector<StatedLens> read_stream(const CalibrationText& text, const std::vector<Line>& lines,
                                    const std::string& stream) {
  std::vector<StatedLens> found;
  bool is_inside = false, is_inverse = false;
  for (const Line& line : lines) {
    const auto words = split(line.text, " \t\r:");
    if (words.empty()) continue;
    if (words[0] == "Intrinsic" || words[0] == "Extrinsic") {
      is_inside = words[0] == "Intrinsic" && line.text.find("\"" + stream + "\"") != std::string::npos;
      if (is_inside) found.emplace_back(text.file, "Intrinsic of \"" + stream + "\"", "Coeffs");
      continue;
    }
    if (!is_inside) continue;
    Lens& lens = found.back().lens;
    const auto number = [&] { return numbers_in(after_colon(line.text), text.file, line.number).at(0); };
    if (words[0] == "Width") lens.camera.width = static_cast<int>(number());
    if (words[0] == "Height") lens.camera.height = static_cast<int>(number());
    if (words[0] == "PPX") lens.camera.cx = number();
    if (words[0] == "PPY") lens.camera.cy = number();
    if (words[0] == "Fx") lens.camera.fx = number();
    if (words[0] == "Fy") lens.camera.fy = number();
    if (words[0] == "Distortion") {
      is_inverse = line.text.find("Inverse") != std::string::npos;
      if (line.text.find("Kannala") != std::string::npos) lens.model = LensModel::equidistant;
    }
    if (words[0] == "Coeffs") {
      lens.parameters = numbers_in(after_colon(line.text), text.file, line.number);
      if (is_inverse && std::any_of(lens.parameters.begin(), lens.parameters.end(), [](double k) { return k != 0; }))
        fail(text.file, line.number, "coefficients of the inverse distortion", "zeros, or another model");
      if (lens.model == LensModel::equidistant) lens.parameters.resize(4);
    }
  }
  // A resolution is printed once per pixel format.
  std::vector<StatedLens> distinct;
  for (const StatedLens& lens : found)
    if (of_size(distinct, lens) == distinct.end()) distinct.push_back(lens);
  return distinct;
}

Eigen::Isometry3d read_extrinsics(const CalibrationText& text, const std::vector<Line>& lines, const std::string& from,
                                  const std::string& to) {
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::string& line = lines[i].text;
    const std::size_t first = line.find("\"" + from + "\""), second = line.find("\"" + to + "\"");
    if (line.find("Extrinsic") == std::string::npos || first == std::string::npos || second == std::string::npos ||
        first > second || i + 5 >= lines.size())
      continue;
    Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();
    for (std::size_t row = 0; row < 3; ++row) {
      const auto values = numbers_in(lines[i + 2 + row].text, text.file, lines[i + 2 + row].number);
      if (values.size() != 3) fail(text.file, lines[i + 2 + row].number, counted(values.size(), "number"), "3");
      transform.linear().row(static_cast<int>(row)) << values[0], values[1], values[2];
    }
    const auto t = numbers_in(after_colon(lines[i + 5].text), text.file, lines[i + 5].number);
    if (t.size() != 3) fail(text.file, lines[i + 5].number, counted(t.size(), "number"), "a translation vector");
    transform.translation() << t[0], t[1], t[2];
    return transform;
  }
  fail(text.file, "no extrinsics from \"" + from + "\" to \"" + to + "\"", "what `rs-enumerate-devices -c` prints");
}

bool is_realsense(const CalibrationText& text) {
  return text.text.find("Intrinsic of \"") != std::string::npos ||
         text.text.find("Stream Profiles supported by") != std::string::npos;
}

StatedCalibration read_realsense(const std::vector<CalibrationText>& texts) {
  const CalibrationText& text = texts[0];
  const auto lines = data_lines(text.file);
  for (const std::string kind : {"Infrared", "Fisheye"}) {
    const std::string left = kind + " 1", right = kind + " 2";
    const auto lefts = read_stream(text, lines, left), rights = read_stream(text, lines, right);
    StatedCalibration stated;
    for (const StatedLens& one : lefts) {
      const auto other = of_size(rights, one);
      if (other == rights.end()) continue;
      StatedCalibration pair;
      pair.left = one;
      pair.right = *other;
      pair.right_from_left = read_extrinsics(text, lines, left, right);
      if (stated.left.file.empty())
        stated = pair;
      else
        stated.other_sizes.push_back(pair);
    }
    if (!stated.left.file.empty()) return stated;
  }
  fail(text.file, "no intrinsics of Infrared 1 and 2, or Fisheye 1 and 2",
       "what `rs-enumerate-devices -c` prints of a stereo camera");
}

}  // namespace

const CalibrationForm kRealsense{"realsense", "what `rs-enumerate-devices -c` prints", false, is_realsense,
                                 read_realsense};

}  // namespace quadedge::data
