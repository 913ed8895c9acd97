#pragma once
/// \file command.hpp  What a command of the program is, and how it declares its options. Free of CLI11.

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "quadedge/config.hpp"

namespace quadedge::cli {

/// Collects the options of one command. Names are written "-o,--output"; each variable's present value is the default.
class Options {
 public:
  virtual ~Options() = default;
  /// A positional argument.
  virtual void positional(const std::string& name, std::string& value, const std::string& help,
                          bool required = true) = 0;
  /// One or more positional arguments, or any number if not `required`; the last ones of the command.
  virtual void positionals(const std::string& name, std::vector<std::string>& values, const std::string& help,
                           bool required = true) = 0;
  virtual void text(const std::string& names, std::string& value, const std::string& help,
                    const std::string& placeholder) = 0;
  /// One or two files: "LEFT,RIGHT", or given twice.
  virtual void files(const std::string& names, std::string& value, const std::string& help,
                     const std::string& placeholder) = 0;
  /// A text that names a file to write. Two of a command may not name the same file, nor one that the command reads.
  virtual void output(const std::string& names, std::string& value, const std::string& help) = 0;
  virtual void number(const std::string& names, double& value, const std::string& help) = 0;
  virtual void number(const std::string& names, int& value, const std::string& help) = 0;
  virtual void number(const std::string& names, std::uint64_t& value, const std::string& help) = 0;
  /// Takes no value.
  virtual void flag(const std::string& names, bool& value, const std::string& help) = 0;
  virtual void choice(const std::string& names, std::string& value, const std::vector<std::string>& allowed,
                      const std::string& help) = 0;
  /// May be repeated, one value each time.
  virtual void repeated(const std::string& names, std::vector<std::string>& values, const std::string& help,
                        const std::string& placeholder) = 0;
  /// A constant of the method, with its help, unit and range.
  virtual void constant(const Constant& constant, Config& config) = 0;
  /// The option declared last also reads an environment variable.
  virtual void environment(const std::string& variable) = 0;
  /// Heading of the following options in the help; `only_in_full_help`: shown by --help-all alone.
  virtual void group(const std::string& heading, bool only_in_full_help = false) = 0;
  /// `--preset NAME` and `--config FILE.toml`: values for the options that neither command line nor environment gives;
  /// the file wins over the preset. A key is the name of an option without dashes.
  virtual void config_file() = 0;
};

/// One command of the program.
class Command {
 public:
  /// \param name      "run", or "evaluate trajectory" for a command of a group
  /// \param about     one sentence
  /// \param examples  two lines that can be typed
  Command(std::string name, std::string about, std::string examples)
      : name_(std::move(name)), about_(std::move(about)), examples_(std::move(examples)) {}
  virtual ~Command() = default;
  const std::string& name() const { return name_; }
  const std::string& about() const { return about_; }
  const std::string& examples() const { return examples_; }
  virtual void declare(Options& options) = 0;
  /// Does the work after the options are set. Returns the exit code; \throws Error.
  virtual int run() = 0;

 private:
  std::string name_, about_, examples_;
};

std::unique_ptr<Command> make_run_command();
std::unique_ptr<Command> make_localise_command();
std::unique_ptr<Command> make_demo_command();
std::unique_ptr<Command> make_edges_command();
std::unique_ptr<Command> make_match_command();
std::unique_ptr<Command> make_check_command();
std::unique_ptr<Command> make_calibrate_command();
std::unique_ptr<Command> make_batch_command();
std::unique_ptr<Command> make_report_command();
std::unique_ptr<Command> make_bench_command();
std::unique_ptr<Command> make_compare_command();
std::unique_ptr<Command> make_devices_command();
std::unique_ptr<Command> make_variants_command();
std::unique_ptr<Command> make_synth_command();
std::unique_ptr<Command> make_evaluate_trajectory_command();

}  // namespace quadedge::cli
