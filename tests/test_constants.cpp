/// \file test_constants.cpp  The declarations of quadedge/constants.inc and what is generated from them.
#include "dataset_files.hpp"
#include "program.hpp"

using namespace quadedge;
using Catch::Matchers::Contains;

namespace {

const Constant& constant_named(const std::string& key) {
  for (const auto& constant : constants())
    if (constant.key() == key) return constant;
  throw std::runtime_error("no constant " + key);
}

}  // namespace

TEST_CASE("constants: each has a separate field, a valid default and a known section") {
  Config config;
  CHECK_NOTHROW(check_config(config));
  std::set<std::string> keys, sections;
  std::set<const void*> fields;
  for (const auto& section : constant_sections()) sections.insert(section.name);
  for (const auto& constant : constants()) {
    INFO(constant.key());
    CHECK(keys.insert(constant.key()).second);
    CHECK(fields.insert(std::visit([](auto* field) -> const void* { return field; }, constant.field(config))).second);
    CHECK((constant.section.empty() || sections.count(constant.section) == 1));
    CHECK(!constant.help.empty());
  }
  CHECK(constant_named("stereo.ncc_min").field(config) == ConfigField(&config.stereo.ncc_min));
  CHECK(constant_named("seed").field(config) == ConfigField(&config.seed));
}

TEST_CASE("constants: values outside the range are refused, its ends are accepted") {
  Config config;
  const auto fails = [&] { return message_of([&] { check_config(config); }); };
  for (const double value : {0.01, 1.0}) {
    config.stereo.ncc_min = value;
    CHECK(fails() == "");
  }
  for (const double value : {0.009, 1.001, std::nan(""), HUGE_VAL}) {
    config.stereo.ncc_min = value;
    CHECK_THAT(fails(), Contains("stereo.ncc_min is ") && Contains("0.01 to 1"));
  }
  config = {};
  config.edges.direction_at = "nowhere";
  CHECK_THAT(fails(), Contains("edges.direction_at is nowhere") && Contains("subpixel, pixel"));
  config = {};
  config.pose.min_inliers = 1;
  CHECK_THAT(fails(), Contains("pose.min_inliers is 1; allowed: at least 2"));
  config = {};
  config.seed = std::uint64_t{1} << 53;
  CHECK(fails() == "");
  ++config.seed;
  CHECK_THAT(fails(), Contains("seed is 9007199254740993; allowed: 0 to 9007199254740992"));
}

TEST_CASE("constants: angles are given in degrees and returned in radians") {
  Config config;
  config.stereo.orientation = 90;
  CHECK(config.stereo.orientation_rad() == Approx(std::acos(0.0)));
  CHECK(constant_named("stereo.orientation").unit == "deg");
}

TEST_CASE("constants: the short help lists the basic ones, the full help all of them, by section", "[cli]") {
  const std::string brief = run_program({"run", "--help"}).out, full = run_program({"run", "--help-all"}).out;
  for (const auto& constant : constants()) {
    INFO(constant.key());
    const std::string option = "--" + constant.key() + " ";
    CHECK((brief.find(option) != std::string::npos) == constant.basic);
    CHECK(full.find(option) != std::string::npos);
  }
  const auto heading = full.find("\nStereo cascade (doc/method.md section 3):");
  REQUIRE(heading != std::string::npos);
  CHECK(full.find("--stereo.mutual_radius") > heading);
  CHECK(full.find("--stereo.mutual_radius") < full.find("\nTemporal cascade"));
}

namespace {

std::string row(const Constant& constant, const Config& defaults) {
  const std::string mark = constant.basic ? "**" : "";
  const auto after = [](const std::string& before, const std::string& text, const char* end) {
    return text.empty() ? "" : before + text + end;
  };
  return "| " + mark + "`" + constant.key() + "`" + mark + " | " + constant.text(defaults) +
         after(" ", constant.unit, "") + " | " + constant.allowed() + " | " + constant.help +
         after(" (paper: ", constant.paper, ")") + " |\n";
}

const std::string kPage = QUADEDGE_KERNELS "/../doc/configuration.md";

/// The page with the table of all constants behind its heading.
std::string configuration_page() {
  const Config defaults;
  const std::string now = read_text(kPage), heading = "|---|---|---|---|\n";
  std::string page = now.substr(0, now.find(heading)) + heading, section;
  for (const Constant& constant : constants()) {
    if (constant.section != section) {
      section = constant.section;
      for (const auto& known : constant_sections())
        if (known.name == section)
          page += "| *" + known.title + "* | | | *[method.md](method.md), section " +
                  std::to_string(known.method_section) + "* |\n";
    }
    page += row(constant, defaults);
  }
  return page;
}

}  // namespace

TEST_CASE("constants: doc/configuration.md lists those of the program") {
  const std::string page = read_text(kPage);
  CHECK_THAT(page, Contains("| `stereo.epipolar_distance` | 0.5 px | 0 to 20 |"));
  CHECK(page == configuration_page());
}

TEST_CASE("write doc/configuration.md", "[.]") { write_text(kPage, configuration_page()); }
