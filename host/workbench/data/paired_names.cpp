/// \file paired_names.cpp  A folder with the images of both cameras, told apart by their names: I1_000060.png and
/// I2_000060.png (Karlsruhe), NAME_left.png and NAME_right.png, left_NAME and right_NAME, NAME_l and NAME_r. It needs
/// --calibration, and times in its names or times.txt, else 10 Hz is assumed.

#include <map>
#include <optional>

#include "data/image_list.hpp"
#include "data/layout.hpp"
#include "data/text.hpp"

namespace quadedge::data {
namespace {

struct Marks {
  const char *left, *right;
  bool is_prefix;
};
constexpr Marks kMarks[] = {{"I1_", "I2_", true}, {"_left", "_right", false}, {"left_", "right_", true},
                            {"_l", "_r", false},  {"_L", "_R", false},        {"left", "right", true},
                            {"_0", "_1", false}};

/// What a stem has besides its mark; nothing if it does not have it.
std::optional<std::string> without(const std::string& stem, const std::string& mark, bool is_prefix) {
  if (stem.size() <= mark.size()) return std::nullopt;
  const std::size_t at = is_prefix ? 0 : stem.size() - mark.size();
  if (stem.compare(at, mark.size(), mark) != 0) return std::nullopt;
  return is_prefix ? stem.substr(mark.size()) : stem.substr(0, at);
}

struct Pairs {
  std::vector<std::string> names;  ///< what both names of a pair have in common, in natural order
  std::vector<std::pair<std::string, std::string>> files;
  std::string unpaired;  ///< a left image without its right one
};

/// The images of a folder by the marks that at least two pairs have.
Pairs find_pairs(const fs::path& folder) {
  std::vector<fs::path> images;
  for (const auto& entry : fs::directory_iterator(folder))
    if (is_image_name(entry.path().filename().string())) images.push_back(entry.path());
  for (const Marks& marks : kMarks) {
    std::map<std::string, std::string> left, right;
    for (const fs::path& image : images) {
      const std::string stem = image.stem().string();
      if (const auto name = without(stem, marks.left, marks.is_prefix)) left[*name] = image.string();
      if (const auto name = without(stem, marks.right, marks.is_prefix)) right[*name] = image.string();
    }
    Pairs pairs;
    for (const auto& entry : left) {
      if (right.count(entry.first) > 0)
        pairs.names.push_back(entry.first);
      else
        pairs.unpaired = entry.second;
    }
    if (pairs.names.size() < 2) continue;
    std::sort(pairs.names.begin(), pairs.names.end(), comes_before);
    for (const std::string& name : pairs.names) pairs.files.emplace_back(left[name], right[name]);
    return pairs;
  }
  return {};
}

bool is_paired_names(const fs::path& folder) { return !find_pairs(folder).names.empty(); }

Dataset read_paired_names(const fs::path& folder, const DatasetOptions& options, Findings& findings) {
  Dataset dataset;
  const Pairs pairs = find_pairs(folder);
  if (!pairs.unpaired.empty())
    findings.error(pairs.unpaired, "a left image alone", "the right image of the same name beside it");
  auto stamps = stamps_of_names(pairs.names, folder.string());
  if (const fs::path times = folder / "times.txt"; !stamps && fs::exists(times)) {
    stamps = read_times(times.string());
    if (stamps->size() != pairs.files.size())
      findings.error(times.string(), counted(stamps->size(), "time"),
                     std::to_string(pairs.files.size()) + ", one per pair");
  }
  if (!stamps) dataset.notes.push_back("the images have no timestamps; 10 Hz is assumed");
  constexpr std::int64_t kPeriodNs = 100'000'000;
  for (std::size_t i = 0; i < pairs.files.size(); ++i) {
    const std::int64_t stamp = stamps && i < stamps->size() ? (*stamps)[i] : static_cast<std::int64_t>(i) * kPeriodNs;
    add_frame(dataset, stamp, pairs.files[i].first, pairs.files[i].second, findings);
  }
  if (options.calibration.empty())
    findings.error(folder.string(), "images without a calibration", "--calibration FILE");
  return dataset;
}

}  // namespace

const Layout kPairedNames{"paired-names", is_paired_names, read_paired_names, is_paired_names};

}  // namespace quadedge::data
