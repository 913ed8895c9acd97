#include <fcntl.h>

#include "data/stream_reader.hpp"
#include "edge_images.hpp"
#include "own_camera.hpp"

using Catch::Matchers::Contains;
using namespace quadedge;
using data::make_picture_pipe;
using data::Split;

namespace {

constexpr int kPipeWidth = 12, kPipeHeight = 7;

Image piped_picture(int number, int width = kPipeWidth, int max_value = 255) {
  return filled_image(width, kPipeHeight, max_value, [=](int x, int y) {
    return (13 * number + 5 * x + 3 * y) * (max_value / 255) % (max_value + 1);
  });
}

std::string pairs(int count, int max_value = 255) {
  std::string text;
  for (int i = 0; i < 2 * count; ++i) text += own_camera::pgm(piped_picture(i, kPipeWidth, max_value));
  return text;
}

/// A file descriptor that delivers the given bytes.
class Source {
 public:
  explicit Source(const std::string& bytes) {
    write_text(folder_ / "bytes", bytes);
    descriptor_ = open((folder_ / "bytes").c_str(), O_RDONLY);
  }
  ~Source() { close(descriptor_); }
  Source(const Source&) = delete;
  Source& operator=(const Source&) = delete;
  int descriptor() const { return descriptor_; }

 private:
  TemporaryFolder folder_;
  int descriptor_ = -1;
};

Dataset dataset_of(std::shared_ptr<const PairStream> stream) {
  Dataset dataset;
  dataset.path = "the test";
  dataset.rig.left.width = dataset.rig.right.width = kPipeWidth;
  dataset.rig.left.height = dataset.rig.right.height = kPipeHeight;
  dataset.stream = std::move(stream);
  return dataset;
}

std::string pipe_complaint(const std::string& bytes, Split split = Split::none) {
  const Source source(bytes);
  const auto reader = make_picture_pipe(source.descriptor(), {split, 10, 0})->open();
  return message_of([&] {
    while (reader->next()) {
    }
  });
}

}  // namespace

TEST_CASE("pipe: images are read in order, at any bit depth, with timestamps by number") {
  for (const int max_value : {255, 4095, 65535}) {
    const Source source(pairs(3, max_value));
    const auto reader = make_picture_pipe(source.descriptor(), {Split::none, 10, 0})->open();
    for (int i = 0; i < 3; ++i) {
      const auto pair = reader->next();
      REQUIRE(pair);
      CHECK(pair->number == i);
      CHECK(pair->stamp_ns == i * 100'000'000);
      CHECK(pair->left.max_value == max_value);
      CHECK(pair->left.pixels == piped_picture(2 * i, kPipeWidth, max_value).pixels);
      CHECK(pair->right.pixels == piped_picture(2 * i + 1, kPipeWidth, max_value).pixels);
    }
    CHECK_FALSE(reader->next());
  }
}

TEST_CASE("pipe: one image may hold both views, and colour becomes grey") {
  for (const bool beside : {true, false}) {
    const Source source(own_camera::pgm(own_camera::joined(piped_picture(0), piped_picture(1), beside)));
    const auto reader =
        make_picture_pipe(source.descriptor(), {beside ? Split::left_right : Split::top_bottom, 10, 0})->open();
    const auto pair = reader->next();
    REQUIRE(pair);
    CHECK(pair->left.pixels == piped_picture(0).pixels);
    CHECK(pair->right.pixels == piped_picture(1).pixels);
  }
  const Source colour("P6 1 1 255\n" + std::string("\xFF\x00\x00", 3) + "P6 1 1 255\n" +
                      std::string("\x50\x50\x50", 3));
  const auto pair = make_picture_pipe(colour.descriptor(), {Split::none, 10, 0})->open()->next();
  REQUIRE(pair);
  CHECK(pair->left.view().value(0, 0) == 76);  // 0.299 x 255
  CHECK(pair->right.view().value(0, 0) == 0x50);
}

TEST_CASE("pipe: errors name the image by number") {
  const std::string one = own_camera::pgm(piped_picture(0)), whole = pairs(2);
  CHECK(pipe_complaint(whole).empty());
  CHECK(pipe_complaint("").empty());
  CHECK_THAT(pipe_complaint(whole + one), Contains("the pipe") && Contains("after a left image"));
  CHECK_THAT(pipe_complaint(whole.substr(0, whole.size() - 5)),
             Contains("image 3 that ends after") && Contains("84 bytes"));
  const std::string wide = own_camera::pgm(piped_picture(1, kPipeWidth + 2));
  CHECK(pipe_complaint(one + wide + one + wide).empty());  // cameras may differ
  CHECK_THAT(pipe_complaint(one + wide + one + one), Contains("image 3 of 12 x 7") && Contains("14 x 7"));
  CHECK_THAT(pipe_complaint(one + one + wide), Contains("image 2 of 14 x 7") && Contains("12 x 7"));
  CHECK_THAT(pipe_complaint(one + own_camera::pgm(piped_picture(1, kPipeWidth, 65535))), Contains("values to 65535"));
  for (const char* head :
       {"hello", "P5 x 7 255\n", "P5 0 7 255\n", "P5 12 7 70000\n", "P5 12", "P4 12 7\n", "P5 99999999999 7 255\n"}) {
    INFO(head);
    CHECK_THAT(pipe_complaint(head), Contains("image 0 without a valid header"));
  }
  CHECK_THAT(pipe_complaint(own_camera::pgm(piped_picture(0, 11)), Split::left_right),
             Contains("11 x 7") && Contains("even width"));
}

TEST_CASE("pipe: a slow reader drops the oldest pairs and counts them") {
  const Source source(pairs(9));
  const auto stream = make_picture_pipe(source.descriptor(), {Split::none, 10, 3});
  FramePrefetcher frames(dataset_of(stream));
  for (int i = 0; i < 500 && frames.dropped() < 6; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  CHECK(frames.dropped() == 6);
  for (int i = 6; i < 9; ++i) {
    const auto frame = frames.next();
    REQUIRE(frame);
    CHECK(frame->number == i);
    CHECK(frame->stamp_ns == i * 100'000'000);
    CHECK(frame->left.pixels == piped_picture(2 * i).pixels);
  }
  CHECK_FALSE(frames.next());
  CHECK_THROWS_AS(stream->open(), UsageError);
}

TEST_CASE("pipe: waiting for an image that never arrives can be interrupted") {
  int ends[2];
  REQUIRE(pipe(ends) == 0);
  const auto start = std::chrono::steady_clock::now();
  {
    FramePrefetcher* asked = nullptr;  // the function may ask the prefetcher something
    FramePrefetcher frames(dataset_of(make_picture_pipe(ends[0], {Split::none, 10, 3})), 2,
                           [&] { return asked != nullptr && asked->dropped() == 0; });
    asked = &frames;
    CHECK_FALSE(frames.next());
  }
  CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(5));
  close(ends[0]);
  close(ends[1]);
}
