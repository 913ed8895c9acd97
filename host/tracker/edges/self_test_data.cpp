/// \file self_test_data.cpp  One list of fields, which one archive reads and another writes.
#include "edges/self_test_data.hpp"

#include <cstring>
#include <limits>
#include <stdexcept>
#include <type_traits>
#include <variant>

namespace quadedge::frontend {
namespace {

const unsigned char kFile[] = {
#include "self_test.inc"
};

class Reader {
 public:
  void operator()(void* to, std::size_t size) {
    std::memcpy(to, at_, size);
    at_ += size;
  }

 private:
  const unsigned char* at_ = kFile;
};

class Writer {
 public:
  void operator()(void* from, std::size_t size) { bytes.append(static_cast<const char*>(from), size); }
  std::string bytes;
};

template <class Archive, class T>
void exchange_size(Archive& archive, T& list) {
  auto size = static_cast<std::uint32_t>(list.size());
  archive(&size, sizeof size);
  list.resize(size);
}

template <class Archive>
void exchange(Archive& archive, std::string& text) {
  exchange_size(archive, text);
  archive(text.data(), text.size());
}

template <class Archive>
void exchange(Archive& archive, PinholeCamera& camera) {
  for (double* value : {&camera.fx, &camera.fy, &camera.cx, &camera.cy}) archive(value, sizeof *value);
  for (int* value : {&camera.width, &camera.height}) archive(value, sizeof *value);
}

template <class Archive>
void exchange(Archive& archive, std::vector<StageRows>& stages) {
  exchange_size(archive, stages);
  for (StageRows& stage : stages) {
    exchange(archive, stage.stage);
    exchange_size(archive, stage.rows);
    for (auto& row : stage.rows) {
      for (int& value : row) {
        auto stored = static_cast<std::int16_t>(value);
        if (stored != value) throw std::out_of_range(stage.stage + ": a number beyond 16 bits");
        archive(&stored, sizeof stored);
        value = stored;
      }
    }
  }
}

template <class Archive>
void exchange(Archive& archive, SelfTestData& data) {
  SmallSequence& sequence = data.sequence;
  exchange(archive, sequence.rig.left);
  exchange(archive, sequence.rig.right);
  archive(sequence.rig.right_from_left.matrix().data(), 16 * sizeof(double));
  archive(&sequence.max_disparity, sizeof(double));
  sequence.rig.max_disparity = sequence.max_disparity;
  for (auto* images : {&sequence.left, &sequence.right}) {
    for (Image& image : *images) {
      if (image.pixels.empty()) image = Image(sequence.rig.left.width, sequence.rig.left.height);
      archive(image.pixels.data(), image.pixels.size());
    }
  }
  exchange(archive, data.expected);
  exchange_size(archive, data.paper);
  for (auto& [name, value] : data.paper) {
    exchange(archive, name);
    archive(&value, sizeof value);
  }
  exchange(archive, data.paper_expected);
}

}  // namespace

Config SelfTestData::paper_config() const {
  Config config;
  config.method = "paper";
  for (const auto& [key, value] : paper) {
    for (const Constant& constant : constants()) {
      if (constant.key() != key) continue;
      std::visit(
          [number = value](auto* field) {
            using Field = std::remove_pointer_t<decltype(field)>;
            if constexpr (std::is_arithmetic_v<Field>) *field = static_cast<Field>(number);
          },
          constant.field(config));
    }
  }
  return config;
}

const SelfTestData& self_test_data() {
  static const SelfTestData data = [] {
    SelfTestData read;
    Reader reader;
    exchange(reader, read);
    return read;
  }();
  return data;
}

std::string bytes_of(const SelfTestData& data) {
  SelfTestData written = data;
  Writer writer;
  exchange(writer, written);
  return writer.bytes;
}

}  // namespace quadedge::frontend
