/// \file zed.cpp  Factory calibration of Stereolabs' ZED cameras, SNxxxx.conf: sections [LEFT_CAM_HD] ... with a camera
/// per resolution, [LEFT_DISTO] with the lens of all of them, and [STEREO] with x_right = R x_left + (-Baseline, TY,
/// TZ) [mm], R by the rotation vector RX_HD, CV_HD, RZ_HD, as Stereolabs' own calibration program writes it.

#include <algorithm>
#include <cctype>
#include <map>

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

std::string upper(std::string text) {
  for (char& letter : text) letter = static_cast<char>(std::toupper(static_cast<unsigned char>(letter)));
  return text;
}

/// Values of an INI file by "SECTION:KEY" in upper case.
class Values {
 public:
  explicit Values(const CalibrationText& text) : file_(text.file) {
    std::string section;
    for (const Line& line : data_lines(text.file)) {
      const auto words = split(upper(line.text), " \t\r=");
      if (words.empty() || words[0][0] == ';') continue;
      if (words[0][0] == '[')
        section = words[0].substr(1, words[0].find(']') - 1);
      else if (words.size() > 1)
        values_[section + ":" + words[0]] = {line.number, words[1]};
    }
  }

  bool has(const std::string& key) const { return values_.count(key) > 0; }
  double number(const std::string& key) const {
    const auto found = values_.find(key);
    if (found == values_.end()) fail(file_, "no value " + key, "a ZED camera's factory calibration");
    return parse_number(found->second.second, file_, found->second.first, key);
  }
  /// The value of a resolution, of all resolutions, or 0.
  double number_for(const std::string& key, const std::string& resolution) const {
    for (const std::string& name : {key + "_" + resolution, key})
      if (has(name)) return number(name);
    return 0;
  }

 private:
  std::string file_;
  std::map<std::string, std::pair<int, std::string>> values_;
};

StatedLens read_lens(const CalibrationText& text, const Values& values, const std::string& side,
                     const Resolution& resolution) {
  const std::string section = side + "_CAM_" + resolution.name, common = side + "_DISTO",
                    lens_section = values.has(common + ":K1") ? common : section;
  StatedLens stated(text.file, section, lens_section);
  Lens& lens = stated.lens;
  lens.camera = {values.number(section + ":FX"), values.number(section + ":FY"), values.number(section + ":CX"),
                 values.number(section + ":CY"), resolution.size.width,          resolution.size.height};
  const auto k = [&](const char* name) {
    return values.has(lens_section + name) ? values.number(lens_section + name) : 0;
  };
  values.number(lens_section + ":K1");  // which every lens states
  const std::vector<double> radial = {k(":K1"), k(":K2"), k(":K3"), k(":K4")};
  // A fisheye's four coefficients, alone or with zeros for the others; a rational function has them all.
  if (radial[3] != 0 && k(":P1") == 0 && k(":P2") == 0 && k(":K5") == 0 && k(":K6") == 0) {
    lens.model = LensModel::equidistant;
    lens.parameters = radial;
  } else {
    lens.parameters = {radial[0], radial[1], k(":P1"), k(":P2"), radial[2]};
    if (radial[3] != 0) lens.parameters.insert(lens.parameters.end(), {radial[3], k(":K5"), k(":K6")});
  }
  return stated;
}

}  // namespace

bool is_zed(const CalibrationText& text) { return text.text.find("[LEFT_CAM_") != std::string::npos; }

StatedCalibration read_zed(const CalibrationText& text) {
  const Values values(text);
  constexpr double kMetres = 1e-3;  // per unit of the file
  StatedCalibration stated;
  for (const Resolution& resolution : kSections) {
    const std::string name = resolution.name;
    if (!values.has("LEFT_CAM_" + name + ":FX")) continue;
    StatedCalibration one;
    one.left = read_lens(text, values, "LEFT", resolution);
    one.right = read_lens(text, values, "RIGHT", resolution);
    const auto value = [&](const char* key) { return values.number_for("STEREO:" + std::string(key), name); };
    one.right_from_left.linear() = rotation_of_vector({value("RX"), value("CV"), value("RZ")}, text.file + " (STEREO)");
    one.right_from_left.translation() =
        kMetres * Eigen::Vector3d(-values.number("STEREO:BASELINE"), value("TY"), value("TZ"));
    if (stated.left.file.empty())
      stated = one;
    else
      stated.other_sizes.push_back(one);
  }
  if (stated.left.file.empty()) fail(text.file, "no section of a known resolution", "[LEFT_CAM_HD] and [RIGHT_CAM_HD]");
  return stated;
}

}  // namespace quadedge::data
