/// \file command_generate.cpp  `quadedge generate`: what is made from the declarations of commands and constants.
#include <iostream>

#include "cli/generated_pages.hpp"
#include "quadedge/error.hpp"

namespace quadedge::cli {
namespace {

class GenerateCommand : public Command {
 public:
  explicit GenerateCommand(const std::vector<std::unique_ptr<Command>>& commands) : commands_(commands) {}

  std::string name() const override { return "generate"; }
  std::string about() const override {
    return "print the manual page, the shell completion, the table of constants or the self-test record";
  }
  std::string examples() const override {
    return "  quadedge generate man | man -l -\n"
           "  source <(quadedge generate bash)\n"
           "  quadedge generate configuration > doc/configuration.md";
  }
  void declare(Options& options) override {
    options.positional("WHAT", what_,
                       "man (quadedge.1), bash (completion script), configuration (doc/configuration.md) or self-test "
                       "(host/frontend/self_test.rows, from the C++ reference)");
  }

  int run() override {
    std::vector<DescribedCommand> described;
    for (const auto& command : commands_) described.push_back(describe(*command));
    if (what_ == "man") {
      std::cout << manual_page(described);
    } else if (what_ == "bash") {
      std::cout << bash_completion(described);
    } else if (what_ == "configuration") {
      std::cout << configuration_page();
    } else if (what_ == "self-test") {
      std::cout << self_test_page();
    } else {
      throw UsageError("generate " + what_ + ": expected man, bash, configuration or self-test");
    }
    return 0;
  }

 private:
  const std::vector<std::unique_ptr<Command>>& commands_;
  std::string what_;
};

}  // namespace

std::unique_ptr<Command> make_generate_command(const std::vector<std::unique_ptr<Command>>& commands) {
  return std::make_unique<GenerateCommand>(commands);
}

}  // namespace quadedge::cli
