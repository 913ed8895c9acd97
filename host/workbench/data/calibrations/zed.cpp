/// \file zed.cpp  Factory calibration of Stereolabs' ZED cameras, SNxxxx.conf: sections [LEFT_CAM_HD] ... with a camera
/// per resolution, [LEFT_DISTO] with the lens of all of them, and [STEREO] with x_right = R x_left + (-Baseline, TY,
/// TZ) [mm], R by the rotation vector RX_HD, CV_HD, RZ_HD, as Stereolabs' own calibration program writes it.

#include <cctype>
#include <sstream>

#include "data/calibrations/forms.hpp"
#include "data/text.hpp"

namespace quadedge::data {
namespace {

struct Resolution {
  const char* name;
  ImageSize size;
};
constexpr Resolution kSections[] = {{"HD", {1280, 720}},  {"FHD", {1920, 1080}},     {"2K", {2208, 1242}},
                                    {"VGA", {672, 376}},  {"FHD1200", {1920, 1200}}, {"SVGA", {960, 600}},
                                    {"4K", {3840, 2160}}, {"QHDPLUS", {3200, 1800}}};

StatedLens read_lens(const YamlMap& values, const std::string& side, const Resolution& resolution) {
  const std::string section = side + "_CAM_" + resolution.name, common = side + "_DISTO";
  const bool has_common = values.has(common) && values.holds_map(common) && values.map(common).has("K1");
  const YamlMap camera = values.map(section), disto = has_common ? values.map(common) : camera;
  StatedLens stated(values.file(), section, has_common ? common : section, camera.numbers_of({"FX", "FY", "CX", "CY"}),
                    resolution.size);
  Lens& lens = stated.lens;
  const auto k = [&](const char* name) { return disto.number_or(name, 0); };
  const std::vector<double> radial = {disto.number("K1"), k("K2"), k("K3"), k("K4")};
  // A fisheye's four coefficients, alone or with zeros for the others; a rational function has them all.
  if (radial[3] != 0 && k("P1") == 0 && k("P2") == 0 && k("K5") == 0 && k("K6") == 0) {
    lens.model = LensModel::equidistant;
    lens.parameters = radial;
  } else {
    lens.parameters = {radial[0], radial[1], k("P1"), k("P2"), radial[2]};
    if (radial[3] != 0) lens.parameters.insert(lens.parameters.end(), {radial[3], k("K5"), k("K6")});
  }
  return stated;
}

StatedCalibration read_zed(const std::vector<CalibrationText>& texts) {
  const YamlMap& values = texts[0].entries();
  constexpr double kMetres = 1e-3;  // per unit of the file
  StatedCalibration stated;
  for (const Resolution& resolution : kSections) {
    const std::string name = resolution.name;
    if (!values.has("LEFT_CAM_" + name)) continue;
    StatedCalibration one;
    one.left = read_lens(values, "LEFT", resolution);
    one.right = read_lens(values, "RIGHT", resolution);
    const YamlMap stereo = values.map("STEREO");
    const auto value = [&](const std::string& key) {  // of the resolution, of all resolutions, or 0
      return stereo.number_or(key + "_" + name, stereo.number_or(key, 0));
    };
    one.right_from_left.linear() =
        rotation_of_vector({value("RX"), value("CV"), value("RZ")}, values.file() + " (STEREO)");
    one.right_from_left.translation() = kMetres * Eigen::Vector3d(-stereo.number("BASELINE"), value("TY"), value("TZ"));
    if (stated.left.file.empty())
      stated = one;
    else
      stated.other_sizes.push_back(one);
  }
  if (stated.left.file.empty())
    fail(values.file(), "no section of a known resolution", "[LEFT_CAM_HD] and [RIGHT_CAM_HD]");
  return stated;
}

}  // namespace

std::string yaml_of_ini(const std::string& ini) {
  std::string yaml;
  std::istringstream lines(ini);
  for (std::string line; std::getline(lines, line); yaml += '\n') {
    for (char& letter : line) letter = static_cast<char>(std::toupper(static_cast<unsigned char>(letter)));
    const auto words = split(line, " \t\r=");
    if (words.empty() || words[0][0] == ';') continue;
    if (words[0][0] == '[')
      yaml += words[0].substr(1, words[0].find(']') - 1) + ":";
    else if (words.size() > 1)
      yaml += "  " + words[0] + ": " + words[1];
  }
  return yaml;
}

const CalibrationForm kZed{
    "zed", "a ZED camera's SNxxxx.conf ([LEFT_CAM_HD], [STEREO])", false,
    [](const CalibrationText& text) { return text.text.find("[LEFT_CAM_") != std::string::npos; }, read_zed};

}  // namespace quadedge::data
