/// \file parser.cpp  The command line with CLI11; the only file that includes it.
#include "cli/parser.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <functional>
#include <iostream>
#include <map>
#include <sstream>
#include <utility>

#include "cli/console.hpp"
#include "common/nearest_word.hpp"
#include "common/printed.hpp"
#include "data/text.hpp"
#include "data/toml_file.hpp"
#include "output/config_toml.hpp"
#include "output/output_folder.hpp"
#include "quadedge/error.hpp"

namespace quadedge::cli {
namespace {

/// Refuses an empty text, which CLI11 reads as 0.
const CLI::Validator kNumber(
    [](const std::string& text) -> std::string { return text.empty() ? "'' is not a number" : ""; }, "");

/// Refuses an empty text, which would count as no option at all.
const CLI::Validator kText([](const std::string& text)
                               -> std::string { return text.empty() ? "expected a value, found an empty one" : ""; },
                           "");

/// Refuses "010" and "0x10" as well, which CLI11 reads as octal and hexadecimal.
const CLI::Validator kDecimal(
    [](const std::string& text) -> std::string {
      const std::size_t digits = text.find_first_not_of("+-");
      const bool other_base = digits != std::string::npos && text[digits] == '0' && digits + 1 < text.size();
      return digits == std::string::npos || other_base ? "'" + text + "' is not a decimal integer" : "";
    },
    "");

/// Options of one command as options of a CLI11 application.
class ParserOptions : public Options {
 public:
  /// `short_help`: options that only the full help shows are hidden.
  ParserOptions(CLI::App& app, bool short_help) : app_(app), short_help_(short_help) {}

  void positional(const std::string& name, std::string& value, const std::string& help, bool required) override {
    inputs_.push_back(&value);
    app_.add_option(name, value, help)->required(required)->check(kText)->type_name("");
  }
  void positionals(const std::string& name, std::vector<std::string>& values, const std::string& help,
                   bool required) override {
    app_.add_option(name, values, help)->required(required)->check(kText)->type_name("");
  }
  void text(const std::string& names, std::string& value, const std::string& help,
            const std::string& placeholder) override {
    if (placeholder != "NAME") inputs_.push_back(&value);
    add(names, value, help)->check(kText)->type_name(placeholder);
  }
  void files(const std::string& names, std::string& value, const std::string& help,
             const std::string& placeholder) override {
    text(names, value, help + "; may be given twice", placeholder);
    last_->multi_option_policy(CLI::MultiOptionPolicy::Join)->delimiter(',');
  }
  void output(const std::string& names, std::string& value, const std::string& help) override {
    outputs_.push_back(&value);
    add(names, value, help)->check(kText)->type_name("FILE");
  }
  void number(const std::string& names, double& value, const std::string& help) override {
    add(names, value, help)->check(kNumber);
  }
  void number(const std::string& names, int& value, const std::string& help) override {
    add(names, value, help)->check(kDecimal);
  }
  void number(const std::string& names, std::uint64_t& value, const std::string& help) override {
    add(names, value, help)->check(kDecimal);
  }
  void flag(const std::string& names, bool& value, const std::string& help) override {
    last_ = app_.add_flag(names, value, help)->group(group_);
    read_from_file(value);
  }
  void choice(const std::string& names, std::string& value, const std::vector<std::string>& allowed,
              const std::string& help) override {
    add_choice(names, value, allowed, help);
    set_from_file([&value, allowed](const data::TomlEntry& entry) {
      data::assign(entry, value);
      if (std::find(allowed.begin(), allowed.end(), value) == allowed.end()) data::refuse(entry, joined(allowed, "|"));
    });
  }
  void repeated(const std::string& names, std::vector<std::string>& values, const std::string& help,
                const std::string& placeholder) override {
    last_ = app_.add_option(names, values, help)->allow_extra_args(false)->check(kText)->group(group_);
    last_->type_name(placeholder);
    read_from_file(values);
  }
  void constant(const Constant& constant, Config& config) override {
    const std::string names = "--" + constant.key();
    const ConfigField field = constant.field(config);
    const std::string range = constant.allowed() + (constant.unit.empty() ? "" : " " + constant.unit);
    const std::string help = constant.help + " (" + range + ")";
    if (auto* const* real = std::get_if<double*>(&field)) add(names, **real, help)->check(kNumber);
    if (auto* const* whole = std::get_if<int*>(&field)) add(names, **whole, help)->check(kDecimal);
    if (auto* const* natural = std::get_if<std::uint64_t*>(&field)) add(names, **natural, help)->check(kDecimal);
    if (auto* const* truth = std::get_if<bool*>(&field)) add(names, **truth, constant.help)->type_name("true|false");
    if (auto* const* word = std::get_if<std::string*>(&field)) {
      add_choice(names, **word, constant.choices, constant.help);
    }
    set_from_file(
        [&constant, &config](const data::TomlEntry& entry) { report::set_constant(entry, constant, config); });
  }
  void environment(const std::string& variable) override { last_->envname(variable); }
  void group(const std::string& heading, bool only_in_full_help) override {
    // CLI11 hides options of the group "", but not from the help alone: its error messages lose their names, too.
    group_ = only_in_full_help && short_help_ ? "" : heading;
    has_full_help_ = has_full_help_ || only_in_full_help;
  }
  void config_file() override {
    app_.add_option(
            "--preset", preset_,
            "number of edges: fast uses half as many as default, dense all of them, for maps; paper: the paper's own "
            "method, for comparison")
        ->check(CLI::IsMember(data::preset_names()).description(""))
        ->type_name(joined(data::preset_names(), "|") + "=default")
        ->group(group_);
    last_ = app_.add_option("--config", config_file_,
                            "TOML file with options, named as here; the command line overrides it")
                ->check(kText)
                ->group(group_)
                ->type_name("FILE");
  }

  /// \throws UsageError where an output would replace another one, or a file that is read.
  void check_outputs() const {
    std::vector<std::string> inputs = {config_file_}, outputs;
    for (const std::string* value : inputs_)
      for (const auto& file : data::split(*value, ",")) inputs.push_back(file);
    for (const std::string* value : outputs_)
      for (const auto& file : data::split(*value, ",")) outputs.push_back(file);
    report::refuse_shared_files(outputs, inputs);
  }

  bool has_full_help() const { return has_full_help_; }

  /// Sets the options of preset and configuration file, also those that command line or environment have set.
  /// \returns whether there are such files
  bool apply_config_file() const {
    if (!preset_.empty()) apply(data::read_preset(preset_));
    if (!config_file_.empty()) apply(data::read_toml(config_file_));
    return !preset_.empty() || !config_file_.empty();
  }

 private:
  void apply(const std::vector<data::TomlEntry>& entries) const {
    for (const auto& entry : entries) {
      const auto setting = from_file_.find(entry.key);
      if (setting == from_file_.end()) data::refuse_key(entry, keys());
      setting->second(entry);
    }
  }

  /// Sets an option to an entry's value.
  using SetFromFile = std::function<void(const data::TomlEntry& entry)>;

  template <class T>
  CLI::Option* add(const std::string& names, T& value, const std::string& help) {
    last_ = app_.add_option(names, value, help)->capture_default_str()->group(group_);
    read_from_file(value);
    return last_;
  }

  void add_choice(const std::string& names, std::string& value, const std::vector<std::string>& allowed,
                  const std::string& help) {
    CLI::Validator member = CLI::IsMember(allowed);
    add(names, value, help)
        ->check(member.description(""))
        ->type_name(joined(allowed, "|"));  // the type name lists them
  }

  /// The option declared last takes values of its type from the file.
  template <class T>
  void read_from_file(T& value) {
    set_from_file([&value](const data::TomlEntry& entry) { data::assign(entry, value); });
  }

  /// The option declared last is set by `set`.
  void set_from_file(const SetFromFile& set) { from_file_[last_->get_lnames().front()] = set; }

  std::vector<std::string> keys() const {
    std::vector<std::string> names;
    for (const auto& setting : from_file_) names.push_back(setting.first);
    return names;
  }

  CLI::App& app_;
  bool short_help_;
  bool has_full_help_ = false;
  std::string group_ = "Options";
  std::string preset_, config_file_;
  CLI::Option* last_ = nullptr;
  std::map<std::string, SetFromFile> from_file_;
  std::vector<const std::string*> inputs_,
      outputs_;  ///< texts that may name a file to read, and that name one to write
};

/// The CLI11 application of a command; makes the group's application ("evaluate") on the way.
CLI::App* add_command(CLI::App& program, std::map<std::string, CLI::App*>& groups, const Command& command) {
  std::istringstream words(command.name());
  std::string first, second;
  words >> first >> second;
  if (second.empty()) return program.add_subcommand(first, command.about());
  CLI::App*& group = groups[first];
  if (group == nullptr) {
    group = program.add_subcommand(first, "compare results with ground truth");
    group->require_subcommand(1);
  }
  return group->add_subcommand(second, command.about());
}

/// The innermost command that the command line names.
const CLI::App& named_command(const CLI::App& program) {
  const CLI::App* app = &program;
  while (!app->get_subcommands().empty()) app = app->get_subcommands().front();
  return *app;
}

/// The error in the command line: an unknown command or option with the most similar known one, else CLI11's message.
std::string complaint(const CLI::App& app, const CLI::Error& error) {
  const std::vector<std::string> unknown = app.remaining();
  if (unknown.empty()) return error.what();
  if (app.get_require_subcommand_min() > 0 && unknown.front()[0] != '-') {
    std::vector<std::string> names;
    for (const CLI::App* command : app.get_subcommands(nullptr)) names.push_back(command->get_name());
    return "unknown command '" + unknown.front() + "'" + did_you_mean(unknown.front(), names);
  }
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const auto& name : option->get_lnames()) names.push_back("--" + name);
  }
  return error.what() + did_you_mean(unknown.front(), names);
}

/// Prints the error and how to get help.
int refuse(const CLI::App& program, const CLI::Error& error) {
  const CLI::App& app = named_command(program);
  print_error(complaint(app, error));
  std::string name;
  for (const CLI::App* part = &app; part != nullptr; part = part->get_parent()) {
    name = part->get_name() + (name.empty() ? "" : " ") + name;
  }
  std::cerr << "`" << name << " --help` lists the options\n";
  return static_cast<int>(ExitCode::usage);
}

}  // namespace

Parsed parse_command_line(int argc, char** argv, const std::vector<std::unique_ptr<Command>>& commands) {
  const std::vector<std::string> words(argv, argv + argc);
  const bool short_help = std::any_of(words.begin() + 1, words.end(),
                                      [](const std::string& word) { return word == "--help" || word == "-h"; });

  CLI::App program("Stereo visual odometry from quadruplets of third-order edges", "quadedge");
  program.set_version_flag("--version", "quadedge " QUADEDGE_VERSION);
  program.require_subcommand(1);
  program.footer(
      "quadedge COMMAND --help shows a command's options, with examples.\n"
      "Exit codes: 0 done, 1 internal error, 2 usage or configuration, 3 data, 4 device or kernel build,\n"
      "5 finished but tracked too few frames, 6 regression found by bench --compare");
  std::vector<std::string> reversed(words.rbegin(), words.rend() - 1);
  std::map<std::string, CLI::App*> groups;
  std::vector<CLI::App*> apps;
  std::vector<std::unique_ptr<ParserOptions>> options;
  for (const auto& command : commands) {
    apps.push_back(add_command(program, groups, *command));
    apps.back()->footer("Examples:\n" + command->examples());
    options.push_back(std::make_unique<ParserOptions>(*apps.back(), short_help));
    command->declare(*options.back());
    if (options.back()->has_full_help()) {
      apps.back()->set_help_all_flag("--help-all", "this help with all constants of the method");
    }
  }
  try {
    program.parse(std::vector(reversed));
  } catch (const CLI::Success& request) {               // --help, --help-all, --version
    const bool is_known = program.remaining().empty();  // CLI11 answers `rnu --help`, too
    return {nullptr, is_known ? program.exit(request) : refuse(program, request)};
  } catch (const CLI::Error& error) {
    return {nullptr, refuse(program, error)};
  }
  for (std::size_t i = 0; i < commands.size(); ++i) {
    if (!apps[i]->parsed()) continue;
    if (options[i]->apply_config_file()) program.parse(reversed);  // the command line wins
    options[i]->check_outputs();
    return {commands[i].get(), 0};
  }
  return {nullptr, static_cast<int>(ExitCode::usage)};
}

}  // namespace quadedge::cli
