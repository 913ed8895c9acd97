/// \file dso.cpp  DSO's camera.txt: a line of model, fx fy cx cy and coefficients (in image sizes if below 1, with
/// pixel corners at integers), a line "width height", two lines of the output image. Without a name, five numbers are
/// the model FOV, or Pinhole if the last is 0, and eight are RadTan. Stereo DSO adds the baseline [m] of a rectified
/// pair in a fifth line.

#include "data/calibrations/forms.hpp"
#include "data/text.hpp"

namespace quadedge::data {
namespace {

constexpr const char* kCameraModels[] = {"Pinhole", "RadTan", "FOV", "EquiDistant", "KannalaBrandt", "Equidistant"};

bool is_number(const std::string& word) { return word.find_first_not_of("0123456789.+-eE") == std::string::npos; }

bool is_stereo_dso(const CalibrationText& text) {
  for (const char* model : kCameraModels)
    if (text.text.rfind(model + std::string(" "), 0) == 0) return true;
  const auto lines = split(text.text, "\r\n");
  const auto first = lines.size() < 4 ? std::vector<std::string>() : split(lines[0]);
  return (first.size() == 5 || first.size() == 8) && std::all_of(first.begin(), first.end(), is_number) &&
         split(lines[1]).size() == 2;
}

StatedCalibration read_stereo_dso(const std::vector<CalibrationText>& texts) {
  const CalibrationText& text = texts[0];
  const auto lines = data_lines(text.file);
  auto words = lines.empty() ? std::vector<std::string>() : split(lines[0].text);
  if (lines.size() < 5) {
    fail(text.file, "the intrinsics of one camera (DSO's camera.txt)",
         "a stereo calibration: Stereo DSO's camera.txt with the baseline in its fifth line, or another format that "
         "holds the transform between the cameras, such as a Kalibr chain");
  }
  if (is_number(words[0])) words.insert(words.begin(), words.size() == 8 ? "RadTan" : "FOV");
  const auto size = parse_row(lines[1], text.file, 2, "width height");
  std::vector<double> k;
  for (std::size_t i = 1; i < words.size(); ++i)
    k.push_back(parse_number(words[i], text.file, lines[0].number, "fx fy cx cy and coefficients"));
  if (k.size() < 4) fail(text.file, lines[0].number, counted(k.size(), "number"), "fx fy cx cy and coefficients");
  const bool is_relative = k[2] < 1 && k[3] < 1;
  const double columns = is_relative ? size[0] : 1, rows = is_relative ? size[1] : 1, corner = is_relative ? 0.5 : 0;
  StatedLens stated(text.file, words[0], words[0],
                    {k[0] * columns, k[1] * rows, k[2] * columns - corner, k[3] * rows - corner},
                    {static_cast<int>(size[0]), static_cast<int>(size[1])});
  Lens& lens = stated.lens;
  lens.parameters.assign(k.begin() + 4, k.end());
  const bool is_fov = words[0] == "FOV" && !lens.parameters.empty() && lens.parameters[0] != 0;
  if (is_fov)
    lens.model = LensModel::field_of_view;
  else if (words[0] == "Pinhole" || words[0] == "FOV")
    lens.parameters.clear();  // Pinhole states a fifth number that is 0
  else if (words[0] != "RadTan")
    lens.model = LensModel::equidistant;
  StatedCalibration calibration;
  calibration.left = calibration.right = stated;
  calibration.right_from_left.translation().x() = -parse_row(lines[4], text.file, 1, "the baseline in metres")[0];
  return calibration;
}

}  // namespace

const CalibrationForm kStereoDso{"stereo-dso", "Stereo DSO's camera.txt (with the baseline in its fifth line)", false,
                                 is_stereo_dso, read_stereo_dso};

}  // namespace quadedge::data
