#include "frontend/self_test_record.hpp"

#include <cstdio>
#include <sstream>
#include <stdexcept>

namespace quadedge::frontend {
namespace {

constexpr const char* kDigits = "0123456789abcdef";

void write(std::ostream& stream, const Image& image) {
  const ImageView view = image.view();
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) stream << kDigits[view.value(x, y) / 16] << kDigits[view.value(x, y) % 16];
    stream << '\n';
  }
}

Image read_image(std::istream& stream, int width, int height) {
  Image image(width, height);
  std::string row;
  for (int y = 0; y < height; ++y) {
    stream >> row;
    if (row.size() != 2 * static_cast<std::size_t>(width))
      throw std::runtime_error("self-test: a row of another width");
    for (int x = 0; x < width; ++x)
      image.set(x, y, std::stoi(row.substr(2 * static_cast<std::size_t>(x), 2), nullptr, 16));
  }
  return image;
}

}  // namespace

std::string to_text(const SelfTestRecord& record) {
  const SmallSequence& sequence = record.sequence;
  std::ostringstream stream;
  char numbers[160];
  const PinholeCamera& camera = sequence.rig.left;
  std::snprintf(numbers, sizeof numbers, "%d %d %.17g %.17g %.17g %.17g %.17g\n", camera.width, camera.height,
                camera.fx, camera.cx, camera.cy, sequence.rig.baseline(), sequence.max_disparity);
  stream << numbers;
  for (int i = 0; i < 2; ++i) {
    write(stream, sequence.left[i]);
    write(stream, sequence.right[i]);
  }
  for (const StageRows& stage : record.stages) {
    stream << stage.rows.size() << ' ' << stage.stage << '\n';
    for (const auto& row : stage.rows)
      stream << row[0] << ' ' << row[1] << ' ' << row[2] << ' ' << row[3] << ' ' << row[4] << '\n';
  }
  return stream.str();
}

SelfTestRecord parse_self_test(const std::string& text) {
  std::istringstream stream(text);
  SelfTestRecord record;
  SmallSequence& sequence = record.sequence;
  PinholeCamera& camera = sequence.rig.left;
  double baseline = 0;
  stream >> camera.width >> camera.height >> camera.fx >> camera.cx >> camera.cy >> baseline >> sequence.max_disparity;
  camera.fy = camera.fx;
  sequence.rig.right = camera;
  sequence.rig.right_from_left.translation() = Eigen::Vector3d(-baseline, 0, 0);
  for (int i = 0; i < 2; ++i) {
    sequence.left[i] = read_image(stream, camera.width, camera.height);
    sequence.right[i] = read_image(stream, camera.width, camera.height);
  }
  std::size_t count = 0;
  while (stream >> count) {
    StageRows& stage = record.stages.emplace_back();
    std::getline(stream >> std::ws, stage.stage);
    stage.rows.resize(count);
    for (auto& row : stage.rows)
      for (int& value : row) stream >> value;
  }
  if (!stream.eof() || record.stages.empty()) throw std::runtime_error("self-test: the stored results are cut");
  return record;
}

}  // namespace quadedge::frontend
