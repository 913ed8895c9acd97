#include "cli/described_command.hpp"

#include <sstream>

#include "data/presets.hpp"

namespace quadedge::cli {
namespace {

/// "-o,--output" as two names.
std::vector<std::string> separate(const std::string& names) {
  std::vector<std::string> list;
  std::istringstream text(names);
  for (std::string name; std::getline(text, name, ',');) list.push_back(name);
  return list;
}

template <class T>
std::string number_text(T value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

/// Writes down what a command declares.
class Recorder : public Options {
 public:
  explicit Recorder(std::vector<DescribedOption>& list) : list_(list) {}

  void positional(const std::string& name, std::string&, const std::string& help, bool required) override {
    add(name, "", help, "");
    list_.back().positional = true;
    list_.back().required = required;
  }
  void positionals(const std::string& name, std::vector<std::string>&, const std::string& help) override {
    add(name, "", help, "");
    list_.back().positional = list_.back().required = list_.back().repeated = true;
  }
  void text(const std::string& names, std::string& value, const std::string& help,
            const std::string& placeholder) override {
    add(names, placeholder, help, value);
  }
  void number(const std::string& names, double& value, const std::string& help) override {
    add(names, "NUMBER", help, number_text(value));
  }
  void number(const std::string& names, int& value, const std::string& help) override {
    add(names, "NUMBER", help, number_text(value));
  }
  void number(const std::string& names, std::uint64_t& value, const std::string& help) override {
    add(names, "NUMBER", help, number_text(value));
  }
  void flag(const std::string& names, bool&, const std::string& help) override { add(names, "", help, ""); }
  void choice(const std::string& names, std::string& value, const std::vector<std::string>& allowed,
              const std::string& help) override {
    add(names, "WORD", help, value);
    list_.back().choices = allowed;
  }
  void repeated(const std::string& names, std::vector<std::string>&, const std::string& help,
                const std::string& placeholder) override {
    add(names, placeholder, help, "");
    list_.back().repeated = true;
  }
  void constant(const std::string& names, const Constant& constant, Config& config) override {
    const bool is_word = !constant.choices.empty();
    const bool is_switch = std::holds_alternative<bool*>(constant.field(config));
    add(names, is_word || is_switch ? "WORD" : "NUMBER", constant.help, constant.text(config));
    DescribedOption& option = list_.back();
    option.is_constant = true;
    option.choices = is_switch ? std::vector<std::string>{"true", "false"} : constant.choices;
    if (option.choices.empty()) {
      option.help += " (" + constant.allowed() + (constant.unit.empty() ? "" : " " + constant.unit) + ")";
    }
  }
  void environment(const std::string& variable) override { list_.back().environment = variable; }
  void group(const std::string& heading, bool) override { heading_ = heading; }
  void config_file() override {
    add("--preset", "WORD", "accuracy against speed: accurate uses all edges, fast half as many as default", "default");
    list_.back().choices = data::preset_names();
    add("--config", "FILE", "TOML file with options, named as here; the command line overrides it", "");
  }

 private:
  void add(const std::string& names, const std::string& placeholder, const std::string& help,
           const std::string& default_text) {
    DescribedOption& option = list_.emplace_back();
    option.names = separate(names);
    option.placeholder = placeholder;
    option.help = help;
    option.default_text = default_text;
    option.heading = heading_;
  }

  std::vector<DescribedOption>& list_;
  std::string heading_ = "Options";
};

}  // namespace

DescribedCommand describe(Command& command) {
  DescribedCommand described{command.name(), command.about(), command.examples(), {}};
  Recorder recorder(described.options);
  command.declare(recorder);
  return described;
}

}  // namespace quadedge::cli
