/// \file bash_completion.cpp  The completion script for bash.
#include <map>
#include <set>
#include <sstream>

#include "cli/generated_pages.hpp"

namespace quadedge::cli {
namespace {

// Where there are no words, bash completes file names (-o default).
constexpr const char* kCompletionTail = R"(
  esac
  COMPREPLY=($(compgen -W "$words" -- "$current"))
}
complete -o default -F _quadedge quadedge
)";

std::string joined(const std::set<std::string>& words) {
  std::string text;
  for (const auto& word : words) text += (text.empty() ? "" : " ") + word;
  return text;
}

/// First words of all commands, and under each word of a group its second ones.
std::map<std::string, std::set<std::string>> command_words(const std::vector<DescribedCommand>& commands) {
  std::map<std::string, std::set<std::string>> words;
  for (const auto& command : commands) {
    std::istringstream name(command.name);
    std::string first, second;
    name >> first >> second;
    auto& group = words[first];
    if (!second.empty()) group.insert(second);
  }
  return words;
}

/// One case per option whose words are known, and one with the options of the command.
std::string cases(const DescribedCommand& command) {
  std::string text;
  std::set<std::string> names{"--help"};
  for (const auto& option : command.options) {
    if (option.positional) continue;
    names.insert(option.names.begin(), option.names.end());
    if (option.is_constant) names.insert("--help-all");
    if (option.choices.empty()) continue;
    std::string pattern;
    for (const auto& name : option.names)
      pattern += (pattern.empty() ? "" : "|") + ("'" + command.name + " " + name + "'");
    text += "    " + pattern + ") words='" + joined({option.choices.begin(), option.choices.end()}) + "' ;;\n";
  }
  return text + "    '" + command.name + " '*) [[ $current == -* ]] && words='" + joined(names) + "' ;;\n";
}

}  // namespace

std::string bash_completion(const std::vector<DescribedCommand>& commands) {
  const auto words = command_words(commands);
  std::set<std::string> first{"--help", "--version"};
  std::string groups;
  for (const auto& [word, seconds] : words) {
    first.insert(word);
    if (seconds.empty()) continue;
    groups += "    " + word + ")\n      command=\"" + word +
              " ${COMP_WORDS[2]}\"\n      ((COMP_CWORD == 2)) && command=group " + "words='" + joined(seconds) +
              " --help' ;;\n";
  }
  std::string script =
      "# bash completion for quadedge; made by `quadedge generate bash`\n"
      "_quadedge() {\n"
      "  local current=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} command=${COMP_WORDS[1]} words=\n"
      "  case $command in\n" +
      groups + "  esac\n  ((COMP_CWORD == 1)) && command=group words='" + joined(first) +
      "'\n  case \"$command $before\" in\n";
  for (const auto& command : commands) script += cases(command);
  return script.substr(0, script.size() - 1) + kCompletionTail;
}

}  // namespace quadedge::cli
