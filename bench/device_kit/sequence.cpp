#include "device_kit/sequence.hpp"

#include <fstream>
#include <iomanip>
#include <limits>
#include <sstream>
#include <stdexcept>

namespace device_kit {
namespace {

using quadedge::Image;
using quadedge::PinholeCamera;
using quadedge::PixelMask;
using quadedge::UndistortionTable;

template <class Stream>
Stream opened(const std::string& file) {
  Stream stream(file, std::ios::binary);
  if (!stream) throw std::runtime_error(file + ": cannot be opened");
  return stream;
}

std::string image_file(const std::string& folder, const char* side, std::size_t frame) {
  return folder + "/" + side + "_" + std::to_string(frame) + ".pgm";
}

void write_pgm(const std::string& file, const Image& image) {
  if (image.max_value != quadedge::kMaxValue8) throw std::runtime_error(file + ": images of more than 8 bits");
  auto stream = opened<std::ofstream>(file);
  stream << "P5\n" << image.width << ' ' << image.height << "\n255\n";
  stream.write(reinterpret_cast<const char*>(image.pixels.data()), static_cast<std::streamsize>(image.pixels.size()));
  if (!stream.flush()) throw std::runtime_error(file + ": cannot be written");
}

Image read_pgm(const std::string& file) {
  auto stream = opened<std::ifstream>(file);
  std::string magic;
  int width = 0, height = 0, largest = 0;
  stream >> magic >> width >> height >> largest;
  stream.get();
  if (magic != "P5" || largest != quadedge::kMaxValue8 || width < 1 || height < 1)
    throw std::runtime_error(file + ": expected a PGM file (P5) of 8 bits");
  Image image(width, height);
  stream.read(reinterpret_cast<char*>(image.pixels.data()), static_cast<std::streamsize>(image.pixels.size()));
  if (!stream) throw std::runtime_error(file + ": ends early");
  return image;
}

template <class T>
void write_block(std::ostream& stream, const std::vector<T>& values) {
  stream << values.size() << '\n';
  stream.write(reinterpret_cast<const char*>(values.data()), static_cast<std::streamsize>(values.size() * sizeof(T)));
}
template <class T>
void read_block(std::istream& stream, std::vector<T>& values) {
  std::size_t size = 0;
  stream >> size;
  stream.get();
  if (stream) values.resize(size);
  stream.read(reinterpret_cast<char*>(values.data()), static_cast<std::streamsize>(values.size() * sizeof(T)));
}

/// Visits everything of one camera in the order of the file.
template <class Number, class Block>
void visit_camera(PinholeCamera& camera, UndistortionTable& table, PixelMask& mask, Number number, Block block) {
  for (double* value : {&camera.fx, &camera.fy, &camera.cx, &camera.cy}) number(*value);
  for (int* value : {&camera.width, &camera.height, &table.width, &table.height, &mask.width, &mask.height})
    number(*value);
  block(table.source_x);
  block(table.source_y);
  block(mask.hidden);
}
template <class Number, class Block>
void visit_sequence(Sequence& sequence, Number number, Block block) {
  StereoRig& rig = sequence.rig;
  number(rig.max_disparity);
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column) number(rig.right_from_left.matrix()(row, column));
  visit_camera(rig.left, rig.left_undistortion, rig.left_mask, number, block);
  visit_camera(rig.right, rig.right_undistortion, rig.right_mask, number, block);
  for (Frame& frame : sequence.frames) number(frame.stamp_ns);
}

}  // namespace

void write_sequence(const std::string& folder, const Sequence& sequence) {
  Sequence copy = sequence;
  auto stream = opened<std::ofstream>(folder + "/rig");
  stream << sequence.name << '\n' << sequence.frames.size() << '\n' << std::setprecision(17);
  visit_sequence(
      copy, [&](const auto& value) { stream << value << '\n'; },
      [&](const auto& values) { write_block(stream, values); });
  if (!stream.flush()) throw std::runtime_error(folder + "/rig: cannot be written");
  for (std::size_t i = 0; i < sequence.frames.size(); ++i) {
    write_pgm(image_file(folder, "left", i), sequence.frames[i].left);
    write_pgm(image_file(folder, "right", i), sequence.frames[i].right);
  }
}

Sequence read_sequence(const std::string& folder) {
  Sequence sequence;
  auto stream = opened<std::ifstream>(folder + "/rig");
  std::size_t count = 0;
  std::getline(stream, sequence.name);
  stream >> count;
  sequence.frames.resize(count);
  visit_sequence(
      sequence, [&](auto& value) { stream >> value; }, [&](auto& values) { read_block(stream, values); });
  if (!stream) throw std::runtime_error(folder + "/rig: ends early");
  for (std::size_t i = 0; i < count; ++i) {
    sequence.frames[i].left = read_pgm(image_file(folder, "left", i));
    sequence.frames[i].right = read_pgm(image_file(folder, "right", i));
  }
  return sequence;
}

void write_presets(const std::string& file, const std::map<std::string, Config>& presets) {
  auto stream = opened<std::ofstream>(file);
  for (const auto& [name, config] : presets) {
    stream << name;
    for (const auto& constant : quadedge::constants())
      if (constant.text(config) != constant.text(Config()))
        stream << ' ' << constant.key() << '=' << constant.text(config);
    stream << '\n';
  }
  if (!stream.flush()) throw std::runtime_error(file + ": cannot be written");
}

namespace {

void set_constant(Config& config, const std::string& key, const std::string& value) {
  for (const auto& constant : quadedge::constants()) {
    if (constant.key() != key) continue;
    std::istringstream stream(value);
    std::visit([&](auto* field) { stream >> std::boolalpha >> *field; }, constant.field(config));
    if (!stream) throw std::runtime_error(key + "=" + value + ": cannot be read");
    return;
  }
  throw std::runtime_error("there is no constant " + key);
}

}  // namespace

std::map<std::string, Config> read_presets(const std::string& file) {
  auto stream = opened<std::ifstream>(file);
  std::map<std::string, Config> presets;
  for (std::string line; std::getline(stream, line);) {
    std::istringstream words(line);
    std::string name;
    words >> name;
    Config& config = presets[name];
    for (std::string word; words >> word;) {
      const auto equals = word.find('=');
      if (equals == std::string::npos) throw std::runtime_error(file + ": expected KEY=VALUE, found " + word);
      set_constant(config, word.substr(0, equals), word.substr(equals + 1));
    }
  }
  return presets;
}

}  // namespace device_kit
