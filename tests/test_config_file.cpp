/// \file test_config_file.cpp  quadedge/config.hpp: reading, writing, errors.
#include "testing.hpp"

using namespace quadedge;
using Catch::Matchers::Contains;

namespace {

/// The error message of reading the text, with FILE for the file's name.
std::string refusal(const std::string& text) {
  const TemporaryFolder folder;
  const std::string file = folder / "config.toml";
  write_text(file, text);
  const std::string message = message_of([&] { read_config(file); });
  REQUIRE((message.empty() || message.rfind(file, 0) == 0));
  return message.empty() ? "" : "FILE" + message.substr(file.size());
}

/// "[a.a.a...]": nested tables.
std::string nested_tables(int depth) {
  std::string text = "[a";
  for (int i = 1; i < depth; ++i) text += ".a";
  return text + "]\nb = 1\n";
}

}  // namespace

TEST_CASE("config file: every constant survives writing and reading") {
  Config config;
  // Every constant gets a value other than its default: the low or the high end of its range.
  for (const auto& constant : constants()) {
    const ConfigField field = constant.field(config);
    if (auto* const* real = std::get_if<double*>(&field)) **real = **real == constant.low ? 0.1 : constant.low;
    if (auto* const* whole = std::get_if<int*>(&field))
      **whole = static_cast<int>(constant.low) + (**whole == constant.low);
    if (auto* const* truth = std::get_if<bool*>(&field)) **truth = !**truth;
    if (auto* const* word = std::get_if<std::string*>(&field)) **word = constant.choices.back();
  }
  config.seed = 9007199254740991;
  config.variants = {{"scan", "item64"}, {"undistortion", "item64"}};
  const TemporaryFolder folder;
  write_config(folder / "config.toml", config);
  const Config read = read_config(folder / "config.toml"), defaults;
  for (const auto& constant : constants()) {
    INFO(constant.key());
    CHECK(constant.text(read) == constant.text(config));
    CHECK(constant.text(read) != constant.text(defaults));
  }
  CHECK(read.variants == config.variants);
}

TEST_CASE("config file: numbers round-trip bit by bit") {
  Config config;
  config.stereo.ncc_min = 0.1 + 0.2;  // 0.30000000000000004
  config.pose.sigma_across = 1e-6;
  const TemporaryFolder folder;
  write_config(folder / "config.toml", config);
  const Config read = read_config(folder / "config.toml");
  CHECK(read.stereo.ncc_min == config.stereo.ncc_min);
  CHECK(read.pose.sigma_across == config.pose.sigma_across);
}

TEST_CASE("config file: missing keys keep their defaults") {
  const TemporaryFolder folder;
  write_text(folder / "config.toml", "device = \"gpu\"\n[stereo]\nncc_min = 1  # a whole number is a number\n");
  const Config config = read_config(folder / "config.toml");
  CHECK(config.stereo.ncc_min == 1.0);
  CHECK(config.stereo.ncc_nearly_best == Config().stereo.ncc_nearly_best);
  CHECK(config.seed == 42);
}

TEST_CASE("config file: an error names the file, the line, the key, the expected and the actual value") {
  CHECK(refusal("\n\nseed = -1\n") == "FILE:3: seed: expected a whole number of 0 to 9223372036854775807, found -1");
  CHECK(refusal("[pose]\nrefine = 7\n") == "FILE:2: pose.refine: expected true or false, found 7");
  CHECK(refusal("[edges]\nsigma = true\n") == "FILE:2: edges.sigma: expected a number, found true");
  CHECK(refusal("[edges]\nsigma = \"wide\"\n") == "FILE:2: edges.sigma: expected a number, found \"wide\"");
  CHECK(refusal("[edges]\nsigma = 1000\n") == "FILE:2: edges.sigma: expected 0.5 to 8, found 1000");
  CHECK(refusal("[edges]\nsigma = nan\n") == "FILE:2: edges.sigma: expected 0.5 to 8, found nan");
  CHECK_THAT(refusal("[edges]\nmargin = 10.5\n"), Contains("FILE:2: edges.margin: expected a whole number"));
  CHECK_THAT(refusal("[edges]\nmargin = 4294967297\n"), Contains("FILE:2: edges.margin: expected a whole number"));
  CHECK(refusal("[edges]\ndirection_at = \"here\"\n") ==
        "FILE:2: edges.direction_at: expected subpixel, pixel, found \"here\"");
  CHECK(refusal("[edges]\nsigma = [2]\n") == "FILE:2: edges.sigma: expected a number, found an array");
  CHECK(refusal("[stereo]\nncc_mni = 0.5\n") ==
        "FILE:2: unknown key \"stereo.ncc_mni\"; did you mean 'stereo.ncc_min'?");
  CHECK_THAT(refusal("\nvariant = [\"scan\"]\n"), Contains("FILE:2: variant: expected texts of the form STAGE=NAME"));
  CHECK(refusal("\"edges.sigma\" = 2\n[edges]\nsigma = 3\n") == "FILE:3: 'edges.sigma' is given twice");
  // Invalid TOML.
  CHECK_THAT(refusal("seed = 1\nseed = 2\n"), Contains("FILE:2: ") && Contains("'seed'"));
  CHECK_THAT(refusal("[edges]\nsigma = 2\n[stereo]\n[edges]\nsigma = 3\n"),
             Contains("FILE:4: ") && Contains("'edges'"));
  for (const char* text : {"seed = 18446744073709551616\n", "seed = 010\n", "seed =\n", "seed\n", "seed = 1 2\n"}) {
    INFO(text);
    CHECK_THAT(refusal(text), Contains("FILE:1: not TOML"));
  }
  CHECK_THAT(refusal(std::string("seed = 1\0\n", 10)), Contains("FILE:1: not TOML"));
}

TEST_CASE("config file: overlong and deeply nested files end quickly with a message") {
  CHECK_THAT(refusal(std::string(1'000'001, '\n')), Contains("longer than 1 MB"));
  CHECK(refusal(std::string(1'000'000, '\n')) == "");
  CHECK_THAT(refusal("seed = " + std::string(2000, '[')), Contains("FILE:1: not TOML") && Contains("depth"));
  CHECK_THAT(refusal("\nseed = \"" + std::string(5000, 'x')), Contains("FILE:2: longer than 4096 characters"));
  CHECK_THAT(refusal(nested_tables(2000)), Contains("FILE:2: unknown key"));
  std::string numbers = "seed = [\n";
  for (int i = 0; i < 300'000; ++i) numbers += "1,\n";
  CHECK_THAT(refusal(numbers + "]\n"), Contains("FILE:1: seed: expected a whole number") && Contains("found an array"));
  CHECK_THROWS_AS(read_config("/dev/zero"), UsageError);
  CHECK_THROWS_AS(read_config("/"), UsageError);
  CHECK_THROWS_AS(read_config("/no/such/file.toml"), UsageError);
}

TEST_CASE("config file: values that could not be read back are not written") {
  const TemporaryFolder folder;
  Config config;
  config.stereo.ncc_min = 7;
  CHECK_THROWS_AS(write_config(folder / "config.toml", config), UsageError);
  CHECK_FALSE(std::ifstream(folder / "config.toml").good());
  CHECK_THROWS_AS(write_config(folder / "absent/config.toml", Config()), DataError);
}
