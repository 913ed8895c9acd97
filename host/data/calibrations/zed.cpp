/// \file zed.cpp  Factory calibration of Stereolabs' ZED cameras, SNxxxx.conf: sections [LEFT_CAM_HD] ... with a camera
/// per resolution, and [STEREO] with Baseline, TY, TZ [mm] and the rotation vector RX_HD, CV_HD, RZ_HD [rad] of the
/// right camera. Positions are those of the right camera.

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
                                    {"4k", {3840, 2160}}, {"QHDPLUS", {3200, 1800}}};

/// Values of an INI file by "SECTION:KEY".
class Values {
 public:
  explicit Values(const CalibrationText& text) : file_(text.file) {
    std::string section;
    for (const Line& line : data_lines(text.file)) {
      const auto words = split(line.text, " \t\r=");
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
  double number_or(const std::string& key, double otherwise) const { return has(key) ? number(key) : otherwise; }

 private:
  std::string file_;
  std::map<std::string, std::pair<int, std::string>> values_;
};

StatedLens read_lens(const CalibrationText& text, const Values& values, const std::string& section, ImageSize size) {
  StatedLens stated(text.file, section, section);
  stated.lens.camera = {values.number(section + ":fx"),
                        values.number(section + ":fy"),
                        values.number(section + ":cx"),
                        values.number(section + ":cy"),
                        size.width,
                        size.height};
  for (const char* name : {":k1", ":k2", ":p1", ":p2", ":k3"})
    stated.lens.parameters.push_back(values.number_or(section + name, 0));
  if (values.has(section + ":k4"))
    for (const char* name : {":k4", ":k5", ":k6"}) stated.lens.parameters.push_back(values.number(section + name));
  return stated;
}

}  // namespace

StatedCalibration read_zed(const CalibrationText& text) {
  const Values values(text);
  constexpr double kMetres = 1e-3;  // per unit of the file
  StatedCalibration stated;
  for (const auto& [name, size] : kSections) {
    const std::string suffix = name;
    if (!values.has("LEFT_CAM_" + suffix + ":fx")) continue;
    StatedCalibration one;
    one.left = read_lens(text, values, "LEFT_CAM_" + suffix, size);
    one.right = read_lens(text, values, "RIGHT_CAM_" + suffix, size);
    const auto angle = [&](const char* axis) {
      return values.number_or("STEREO:" + std::string(axis) + "_" + suffix,
                              values.number_or("STEREO:" + std::string(axis), 0));
    };
    one.right_from_left.linear() = rotation_of_vector({angle("RX"), angle("CV"), angle("RZ")}, text.file + " (STEREO)");
    one.right_from_left.translation() =
        -kMetres * Eigen::Vector3d(values.number("STEREO:Baseline"), values.number_or("STEREO:TY", 0),
                                   values.number_or("STEREO:TZ", 0));
    if (stated.left.file.empty())
      stated = one;
    else
      stated.other_sizes.push_back(one);
  }
  if (stated.left.file.empty()) fail(text.file, "no section of a known resolution", "[LEFT_CAM_HD] and [RIGHT_CAM_HD]");
  return stated;
}

}  // namespace quadedge::data
