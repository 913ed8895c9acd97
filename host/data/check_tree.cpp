#include "data/check_tree.hpp"

#include <filesystem>

#include "data/find_sequences.hpp"
#include "data/text.hpp"

namespace quadedge::data {

std::vector<TreeMember> find_members(const std::string& root) {
  std::vector<TreeMember> members;
  for (const auto& found : find_recordings(root, true)) {
    members.push_back({std::filesystem::path(found.path).lexically_relative(root).string(), found.format});
  }
  return members;
}

std::string one_line(const DatasetCheck& check) {
  std::string line;
  const auto add = [&](const std::string& text) { line += (line.empty() ? "" : ", ") + text; };
  // Value of a fact: for cameras the image size only, for files without the path.
  const auto value_of = [&](const std::string& name) {
    for (const auto& fact : check.facts) {
      if (fact.rfind(name + ": ", 0) == 0) return fact.substr(name.size() + 2);
    }
    return std::string();
  };
  add(value_of("format"));
  if (const auto frames = value_of("frames"); !frames.empty()) add(frames + (frames == "1" ? " frame" : " frames"));
  if (const auto camera = value_of("left camera"); !camera.empty()) add(camera.substr(0, camera.find(',')) + " px");
  if (const auto truth = value_of("ground truth"); truth.rfind(", ") != std::string::npos) {
    add("ground truth of " + truth.substr(truth.rfind(", ") + 2));
  }
  if (!value_of("disparity of the left view").empty()) add("ground-truth disparity");
  if (!check.warnings.empty()) add(counted(check.warnings.size(), "warning"));
  return line;
}

}  // namespace quadedge::data
