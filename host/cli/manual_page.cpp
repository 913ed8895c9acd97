/// \file manual_page.cpp  quadedge(1).
#include <algorithm>
#include <sstream>

#include "cli/generated_pages.hpp"

namespace quadedge::cli {
namespace {

constexpr const char* kManualHead = R"(.SH NAME
quadedge \- stereo visual odometry from quadruplets of third-order edges
.SH SYNOPSIS
.B quadedge
.I COMMAND
.RI [ ARGUMENTS ]
.RI [ OPTIONS ]
.SH DESCRIPTION
Estimates the trajectory of a stereo camera: third-order edges are matched between left and right images and between
frames, on any OpenCL device, GPU or CPU.
.B quadedge help
.I COMMAND
shows the options of a command, with examples;
.B \-\-help\-all
adds all constants of the method.
.SH COMMANDS
)";

constexpr const char* kManualTail = R"(.SH CONFIGURATION FILE
.B \-\-config
.I FILE
reads a TOML file. Its keys are the names of options without dashes; constants are in tables:
.PP
.EX
seed = 7
[stereo]
ncc_min = 0.5
.EE
.PP
The command line overrides the environment, which overrides the file. Unknown keys are errors.
.SH ENVIRONMENT
.TP
.B QUADEDGE_DEVICE
default of
.B \-\-device
.TP
.B QUADEDGE_PYTHON
the Python that makes HTML pages; it must have the module quadedge.report
.TP
.B XDG_CONFIG_HOME
folder of the kernel variants that
.B quadedge compare \-\-save
keeps (~/.config)
.SH EXIT STATUS
0 done, 1 internal error, 2 usage or configuration, 3 data, 4 device or kernel build,
5 finished but tracked too few frames, 6 regression found by
.B quadedge bench \-\-compare
)";

/// Text that troff takes literally.
std::string escaped(const std::string& text) {
  std::string result;
  for (const char letter : text) {
    if (letter == '\\') {
      result += "\\e";
    } else if (letter == '-') {
      result += "\\-";
    } else {
      result += letter;
    }
    if (letter == '\n') result += "\\&";  // no line is a macro
  }
  return "\\&" + result;
}

std::string item(const DescribedOption& option) {
  std::string names;
  for (const auto& name : option.names) names += (names.empty() ? "" : ", ") + name;
  std::string text = ".TP\n\\fB" + escaped(names) + "\\fR";
  std::string words;
  for (const auto& word : option.choices) words += (words.empty() ? "" : "|") + word;
  if (!option.placeholder.empty()) text += " \\fI" + escaped(words.empty() ? option.placeholder : words) + "\\fR";
  text += "\n" + escaped(option.help);
  if (!option.default_text.empty()) text += escaped("; default: " + option.default_text);
  if (!option.environment.empty()) text += escaped("; environment: " + option.environment);
  return text + "\n";
}

bool has_constants(const DescribedCommand& command) {
  return std::any_of(command.options.begin(), command.options.end(),
                     [](const auto& option) { return option.is_constant; });
}

std::string command_section(const DescribedCommand& command) {
  std::string text = ".SS \"" + escaped("quadedge " + command.name) + "\"\n" + escaped(command.about) + ".\n";
  for (const auto& option : command.options) {
    if (!option.is_constant) text += item(option);
  }
  if (has_constants(command)) text += ".PP\nand all constants of the method, see\n.BR CONSTANTS .\n";
  return text + ".PP\n.EX\n" + escaped(command.examples) + "\n.EE\n";
}

/// The constants, once for all commands, under the headings of the help.
std::string constant_section(const std::vector<DescribedCommand>& commands) {
  const auto command = std::find_if(commands.begin(), commands.end(), has_constants);
  if (command == commands.end()) return "";
  std::string text = ".SH CONSTANTS\nOptions of every computing command.\n", heading;
  for (const auto& option : command->options) {
    if (!option.is_constant) continue;
    if (option.heading != heading) text += ".SS \"" + escaped(option.heading) + "\"\n";
    heading = option.heading;
    text += item(option);
  }
  return text;
}

}  // namespace

std::string manual_page(const std::vector<DescribedCommand>& commands) {
  std::string page =
      std::string(".TH QUADEDGE 1 \"\" \"QuadEdge ") + QUADEDGE_VERSION + "\" \"User Commands\"\n" + kManualHead;
  for (const auto& command : commands) page += command_section(command);
  return page + constant_section(commands) + kManualTail;
}

}  // namespace quadedge::cli
