/// \file parser.cpp  The command line with CLI11; the only file that includes it.
#include "cli/parser.hpp"

#include <CLI/CLI.hpp>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <map>
#include <sstream>

#include "quadedge/error.hpp"

namespace quadedge::cli {
namespace {

/// Options of one command as options of a CLI11 application.
class ParserOptions : public Options {
 public:
  /// `short_help`: options that only the full help shows are hidden.
  ParserOptions(CLI::App& app, bool short_help) : app_(app), short_help_(short_help) {}

  void positional(const std::string& name, std::string& value, const std::string& help, bool required) override {
    app_.add_option(name, value, help)->required(required)->type_name("")->configurable(false);
  }
  void positionals(const std::string& name, std::vector<std::string>& values, const std::string& help) override {
    app_.add_option(name, values, help)->required()->type_name("")->configurable(false);
  }
  void text(const std::string& names, std::string& value, const std::string& help,
            const std::string& placeholder) override {
    add(names, value, help)->type_name(placeholder);
  }
  void number(const std::string& names, double& value, const std::string& help) override { add(names, value, help); }
  void number(const std::string& names, int& value, const std::string& help) override { add(names, value, help); }
  void number(const std::string& names, std::uint64_t& value, const std::string& help) override {
    add(names, value, help);
  }
  void boolean(const std::string& names, bool& value, const std::string& help) override {
    add(names, value, help)->type_name("true|false");
  }
  void flag(const std::string& names, bool& value, const std::string& help) override {
    last_ = app_.add_flag(names, value, help)->group(group_);
  }
  void choice(const std::string& names, std::string& value, const std::vector<std::string>& allowed,
              const std::string& help) override {
    std::string type;
    for (const auto& name : allowed) type += (type.empty() ? "" : "|") + name;
    CLI::Validator member = CLI::IsMember(allowed);
    add(names, value, help)->check(member.description(""))->type_name(type);  // the type says it already
  }
  void repeated(const std::string& names, std::vector<std::string>& values, const std::string& help,
                const std::string& placeholder) override {
    last_ = app_.add_option(names, values, help)->allow_extra_args(false)->group(group_)->type_name(placeholder);
  }
  void environment(const std::string& variable) override { last_->envname(variable); }
  void group(const std::string& heading, bool only_in_full_help) override {
    // CLI11 hides options of the group "", but not from the help alone: its error messages lose their names, too.
    group_ = only_in_full_help && short_help_ ? "" : heading;
    has_full_help_ = has_full_help_ || only_in_full_help;
  }
  void config_file() override {
    text("--config", config_file_, "options from a TOML file, same names as here; the command line wins", "FILE");
    last_->configurable(false);
  }

  bool has_full_help() const { return has_full_help_; }

  /// Sets the options that the configuration file names and nobody has set yet.
  void apply_config_file() {
    if (config_file_.empty()) return;
    std::vector<CLI::ConfigItem> items;
    try {
      if (std::filesystem::is_directory(config_file_)) throw CLI::FileError::Missing(config_file_);
      items = CLI::ConfigTOML().from_file(config_file_);
    } catch (const CLI::FileError&) {
      throw UsageError(config_file_ + ": the configuration file cannot be read");
    }
    for (const auto& item : items) {
      if (item.name == "++" || item.name == "--") continue;  // CLI11's marks for the start and the end of a section
      apply(item);
    }
  }

 private:
  template <class T>
  CLI::Option* add(const std::string& names, T& value, const std::string& help) {
    last_ = app_.add_option(names, value, help)->capture_default_str()->group(group_);
    return last_;
  }

  void apply(const CLI::ConfigItem& item) {
    const std::string key = item.fullname();
    CLI::Option* option = app_.get_option_no_throw("--" + key);
    if (option == nullptr || !option->get_configurable()) {
      throw UsageError(config_file_ + ": unknown key '" + key + "'; `quadedge " + app_.get_name() +
                       " --help-all` lists all options");
    }
    if (option->count() > 0 && configured_.count(option) == 0) return;  // the command line or the environment wins
    if (!configured_.insert({option, key}).second) {
      throw UsageError(config_file_ + ": '" + key + "' is given twice");
    }
    try {
      if (option->get_expected_max() == 0) {
        option->add_result(option->get_flag_value(key, CLI::ConfigTOML().to_flag(item)));
      } else {
        option->add_result(item.inputs);
      }
      option->run_callback();
    } catch (const CLI::Error& error) {
      throw UsageError(config_file_ + ": '" + key + "': " + error.what());
    }
  }

  CLI::App& app_;
  bool short_help_;
  bool has_full_help_ = false;
  std::string group_ = "Options";
  std::string config_file_;
  CLI::Option* last_ = nullptr;
  std::map<CLI::Option*, std::string> configured_;
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

}  // namespace

Parsed parse_command_line(int argc, char** argv, const std::vector<std::unique_ptr<Command>>& commands) {
  bool short_help = false;
  for (int i = 1; i < argc; ++i) {
    short_help = short_help || std::strcmp(argv[i], "--help") == 0 || std::strcmp(argv[i], "-h") == 0;
  }

  CLI::App program("Stereo visual odometry from quadruplets of third-order edges", "quadedge");
  program.set_version_flag("--version", "quadedge " QUADEDGE_VERSION);
  program.require_subcommand(1);
  program.footer(
      "Each command has its own --help with examples, for example: quadedge run --help\n"
      "Exit codes: 0 done, 1 internal error, 2 usage or configuration, 3 data, 4 device or kernel build,\n"
      "5 finished but tracked too few frames, 6 regression found by bench --compare");
  std::map<std::string, CLI::App*> groups;
  std::vector<CLI::App*> apps;
  std::vector<std::unique_ptr<ParserOptions>> options;
  for (const auto& command : commands) {
    apps.push_back(add_command(program, groups, *command));
    apps.back()->footer("Examples:\n" + command->examples());
    options.push_back(std::make_unique<ParserOptions>(*apps.back(), short_help));
    command->declare(*options.back());
    if (options.back()->has_full_help()) {
      apps.back()->set_help_all_flag("--help-all", "this help with every constant of the method");
    }
  }
  try {
    program.parse(argc, argv);
  } catch (const CLI::Success& request) {  // --help, --help-all, --version
    return {nullptr, program.exit(request)};
  } catch (const CLI::Error& error) {
    std::cerr << "quadedge: " << error.what() << "\n";
    std::string help = "quadedge";
    for (const CLI::App* app = &program; !app->get_subcommands().empty();) {
      app = app->get_subcommands().front();
      help += " " + app->get_name();
    }
    std::cerr << "`" << help << " --help` shows what is possible\n";
    return {nullptr, static_cast<int>(ExitCode::usage)};
  }
  for (std::size_t i = 0; i < commands.size(); ++i) {
    if (!apps[i]->parsed()) continue;
    options[i]->apply_config_file();
    return {commands[i].get(), 0};
  }
  return {nullptr, static_cast<int>(ExitCode::usage)};
}

}  // namespace quadedge::cli
