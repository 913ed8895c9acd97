/// \file test_presets.cpp  The files of config/ as presets.
#include "data/toml_file.hpp"
#include "dataset_files.hpp"
#include "program.hpp"

using namespace quadedge;

namespace {

Config effective(const Words& options) {
  const TemporaryFolder folder;
  run_well(Words{"run", small_sequence(), "-o", folder / "out", "--frames", "0:2", "--quiet"} + options);
  return read_config(folder / "out/config.toml");
}

}  // namespace

TEST_CASE("presets: the default preset equals the program's defaults", "[cli]") {
  const Config none, said = read_config(QUADEDGE_KERNELS "/../config/default.toml");
  for (const auto& constant : constants()) CHECK(constant.text(said) == constant.text(none));
  CHECK(data::preset_names() == Words{"fast", "default", "dense", "paper"});
}

TEST_CASE("presets: --preset applies its file; --config and the command line override it", "[cli][device]") {
  CHECK(effective({"--preset", "dense"}).edges.budget == 0);
  CHECK(effective({"--preset", "fast"}).edges.budget == 5000);
  CHECK(effective({"--preset", "dense", "--edges.budget", "9000"}).edges.budget == 9000);
  const TemporaryFolder folder;
  write_text(folder / "mine.toml", "[edges]\nbudget = 9000\n");
  write_text(folder / "other.toml", "[stereo]\nncc_min = 0.5\n");
  CHECK(effective({"--preset", "fast", "--config", folder / "mine.toml"}).edges.budget == 9000);
  const Config both = effective({"--preset", "fast", "--config", folder / "other.toml"});
  CHECK(both.edges.budget == 5000);
  CHECK(both.stereo.ncc_min == 0.5);
  check_error({"run", small_sequence(), "-o", folder / "out", "--preset", "fastest"}, 2, {"--preset", "fastest"});
  CHECK_THROWS_AS(data::read_preset("quick"), UsageError);
}
