/// \file configuration_page.cpp  doc/configuration.md.
#include "cli/generated_pages.hpp"

namespace quadedge::cli {
namespace {

constexpr const char* kPageHead = R"(# Configuration

<!-- Made by `quadedge generate configuration > doc/configuration.md` from include/quadedge/constants.inc. -->

Every constant of the method, as a field of `quadedge::Config` (`config.stereo.ncc_min`), as an option
(`--stereo.ncc_min 0.5`) and as a key of a TOML file (`--config FILE.toml`):

```toml
seed = 7
device = "gpu"
variant = ["edge_detection=tile"]

[stereo]
ncc_min = 0.5
```

A file may set every other option of its command, too, by the name without dashes. The command line wins over the
environment (`QUADEDGE_DEVICE`), and that over the file. Unknown keys, keys that are given twice, values of another type
or out of the range are errors that name file, line and key. Every run leaves its effective configuration in
`config.toml`; `quadedge::read_config()` and `write_config()` (quadedge/config_file.hpp) do the same for a program of
your own. [config/paper.toml](../config/paper.toml) sets what the paper's plain method does otherwise.

Constants in **bold** are the basic ones, shown by `--help`; `--help-all` shows all. Angles are in degrees. The last
column tells where the [paper](method.md) speaks of a constant (section) and the value there if it is another one;
"code" is its authors' published program.
)";

std::string row(const Constant& constant, const Config& defaults) {
  const std::string mark = constant.basic ? "**" : "";
  return "| " + mark + "`" + constant.key() + "`" + mark + " | " + constant.text(defaults) + " | " + constant.unit +
         " | " + constant.allowed() + " | " + constant.help + " | " + constant.paper + " |\n";
}

}  // namespace

std::string configuration_page() {
  const Config defaults;
  const std::string columns = "| constant | default | unit | allowed | meaning | paper |\n|---|---|---|---|---|---|\n";
  std::string page = kPageHead, section;
  page += "\n" + columns;
  for (const Constant& constant : constants()) {
    if (constant.section != section) {
      section = constant.section;
      for (const auto& known : constant_sections()) {
        if (known.name != section) continue;
        page += "\n## " + known.title + "\n\nWhat they do: [method.md](method.md), section " +
                std::to_string(known.method_section) + ".\n\n" + columns;
      }
    }
    page += row(constant, defaults);
  }
  return page;
}

}  // namespace quadedge::cli
