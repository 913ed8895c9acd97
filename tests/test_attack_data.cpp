/// \file test_attack_data.cpp  Attacks with damaged recordings. A row holds a change to a valid recording and the
/// expected message. To add an attack, add a row.

#include <catch2/catch.hpp>
#include <filesystem>
#include <functional>
#include <opencv2/imgcodecs.hpp>
#include <sys/stat.h>

#include "damaged_sequence.hpp"
#include "program.hpp"

using Catch::Matchers::Contains;
namespace fs = std::filesystem;

namespace {

struct DataAttack {
  std::string name;
  std::function<void(const DamagedSequence&)> damage;
  int code;                        ///< exit code of `run`
  std::vector<std::string> words;  ///< expected on standard error
};

void replace_file(const std::string& path, const std::string& text) { std::ofstream(path, std::ios::binary) << text; }

void change_file(const std::string& path, const std::function<std::string(const std::string&)>& change) {
  replace_file(path, change(read_text(path)));
}

/// The second image of a folder by name.
std::string second(const DamagedSequence& sequence, const std::string& folder) {
  return sequence.image(folder, 1).string();
}

/// A file with another content, which `run` refuses with code 3.
struct TextAttack {
  std::string name, file;  ///< of a folder, which ends in a slash, the second image
  std::string text;
  std::vector<std::string> words;  ///< expected on standard error besides the file
};

const std::vector<TextAttack> kTextAttacks = {
    {"an image is empty", "rgb/", "", {}},
    {"an image is a text file", "rgb/", "no picture\n", {}},
    {"an image has a byte too many",
     "rgb/",
     "P5\n320 200\n255\n" + std::string(320 * 200 + 1, 'x'),
     {"64016 bytes", "64015"}},
    {"the header of an image ends with two bytes",
     "rgb2/",
     "P5 320 200 255\r\n" + std::string(320 * 200, 'x'),
     {"64016 bytes", "64015"}},
    {"the calibration is empty", "calibration.txt", "", {}},
    {"the calibration is prose", "calibration.txt", "focal length: about right\n", {}},
    {"a focal length is negative", "calibration.txt", "-184 184 163 97\n", {"-184"}},
    {"a focal length is absurdly large", "calibration.txt", "184 1e308 163 97\n", {"fy of 1e+308"}},
    {"a focal length is absurdly small", "calibration.txt", "184 1e-300 163 97\n", {"fy of 1e-300"}},
    {"a principal point is absurdly far away", "calibration.txt", "184 184 1e308 97\n", {"cx of 1e+308"}},
    {"a focal length has lost its decimal point", "calibration.txt", "184038.7 184.0387 163 97\n", {"184038.7"}},
    {"a focal length is not a number", "calibration.txt", "nan 184 163 97\n", {}},
    {"the baseline is zero", "extrinsics_1_2.txt", "1 0 0 0\n0 1 0 0\n0 0 1 0\n", {"baseline"}},
    {"the baseline is not a number", "extrinsics_1_2.txt", "1 0 0 nan\n0 1 0 0\n0 0 1 0\n", {}},
    {"the cameras' rotation is invalid", "extrinsics_1_2.txt", "2 0 0 0.06\n0 1 0 0\n0 0 1 0\n", {"rotation"}},
    {"the cameras' pose is incomplete", "extrinsics_1_2.txt", "1 0 0 0.06\n0 1 0\n", {}},
    {"the list of images is empty", "rgb.txt", "", {}},
    {"the ground truth is prose", "groundtruth.txt", "somewhere in the room\n", {}},
};

// LONG: a table with one row per attack.
const std::vector<DataAttack>& data_attacks() {
  using Sequence = const DamagedSequence&;
  static const std::vector<DataAttack> attacks = {
      // Images.
      {"a left image is missing", [](Sequence s) { fs::remove(s.image("rgb", 2)); }, 3, {"rgb/", "no such file"}},
      {"a right image is missing", [](Sequence s) { fs::remove(s.image("rgb2", 2)); }, 3, {"rgb2/", "no such file"}},
      {"an image is truncated",
       [](Sequence s) { fs::resize_file(second(s, "rgb2"), fs::file_size(second(s, "rgb2")) / 2); },
       3,
       {"rgb2/"}},
      {"an image has another size",
       [](Sequence s) { cv::imwrite(second(s, "rgb"), cv::Mat(100, 160, CV_8UC1, cv::Scalar(90))); },
       3,
       {"rgb/", "160", "320"}},
      {"an image has another bit depth",
       [](Sequence s) { cv::imwrite(second(s, "rgb2"), cv::Mat(200, 320, CV_16UC1, cv::Scalar(9000))); },
       3,
       {"rgb2/"}},
      {"an image is a folder",
       [](Sequence s) {
         const std::string path = second(s, "rgb");
         fs::remove(path);
         fs::create_directory(path);
       },
       3,
       {"rgb/"}},
      {"an image is a pipe that nobody writes to",
       [](Sequence s) {
         const std::string path = second(s, "rgb");
         fs::remove(path);
         REQUIRE(mkfifo(path.c_str(), 0600) == 0);
       },
       3,
       {"rgb/"}},
      {"all images are black",
       [](Sequence s) {
         for (const char* folder : {"rgb", "rgb2"})
           for (std::size_t i = 0; i < 4; ++i)
             cv::imwrite(s.image(folder, i).string(), cv::Mat(200, 320, CV_8UC1, cv::Scalar(0)));
       },
       5,
       {}},
      // Cameras.
      {"the calibration is missing", [](Sequence s) { fs::remove(s / "calibration.txt"); }, 3, {"calibration.txt"}},
      // Lists.
      {"the list of images is missing, so their names are the timestamps",
       [](Sequence s) { fs::remove(s / "rgb.txt"); },
       0,
       {}},
      {"timestamps go back",
       [](Sequence s) {
         change_file(s / "rgb.txt", [](const std::string& text) {
           const std::size_t last = text.rfind('\n', text.size() - 2) + 1, before = text.rfind('\n', last - 2) + 1;
           return text.substr(0, before) + text.substr(last) + text.substr(before, last - before);
         });
       },
       3,
       {"0.100000000", "increasing"}},
      {"a row is repeated",
       [](Sequence s) {
         change_file(s / "rgb.txt",
                     [](const std::string& text) { return text + text.substr(text.rfind('\n', text.size() - 2) + 1); });
       },
       3,
       {"rgb.txt"}},
      {"the list contains zero bytes",
       [](Sequence s) {
         change_file(s / "rgb.txt", [](const std::string& text) { return text + std::string(1, '\0') + "1\n"; });
       },
       3,
       {"rgb.txt"}},
      {"the list begins with a byte order mark",
       [](Sequence s) { change_file(s / "rgb.txt", [](const std::string& text) { return "\xEF\xBB\xBF" + text; }); },
       0,
       {}},
      {"the list has Windows line endings",
       [](Sequence s) {
         change_file(s / "rgb.txt", [](std::string text) {
           for (std::size_t i = text.find('\n'); i != std::string::npos; i = text.find('\n', i + 2))
             text.insert(i, "\r");
           return text;
         });
       },
       0,
       {}},
      // Ground truth, which is only used for evaluation.
      {"there is no ground truth", [](Sequence s) { fs::remove(s / "groundtruth.txt"); }, 0, {}},
  };
  return attacks;
}

}  // namespace

TEST_CASE("attack: damaged recordings are refused by file name, harmless changes are not", "[cli][device]") {
  std::vector<DataAttack> attacks = data_attacks();
  for (const TextAttack& attack : kTextAttacks) {
    const auto damage = [attack](const DamagedSequence& s) {
      const std::string folder = attack.file.substr(0, attack.file.size() - 1);
      replace_file(attack.file.back() == '/' ? second(s, folder) : s / attack.file, attack.text);
    };
    attacks.push_back({attack.name, damage, 3, attack.words});
    attacks.back().words.push_back(attack.file);
  }
  for (const auto& attack : attacks) {
    DYNAMIC_SECTION(attack.name) {
      const DamagedSequence sequence;
      attack.damage(sequence);
      const TemporaryFolder folder;
      const auto result = run_program({"run", sequence.path(), "-o", folder / "out", "--quiet"});
      INFO(result.err);
      CHECK(result.code == attack.code);
      for (const auto& word : attack.words) CHECK_THAT(result.err, Contains(word));
      CHECK_THAT(result.err, !Contains("internal"));
      if (attack.code == 3) CHECK_THAT(result.err, Contains("expected"));
    }
  }
}
