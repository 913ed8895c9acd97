#pragma once
/// \file markup.hpp  Reads SVG and HTML as another program would.

#include <cstdlib>
#include <fstream>
#include <regex>
#include <string>
#include <vector>

#include "temporary_folder.hpp"

/// Does an XML parser accept the text? (Python's expat; pages are written so that they are XML too.)
inline bool is_well_formed(const std::string& text) {
  const TemporaryFolder folder;
  std::ofstream(folder / "text.xml", std::ios::binary) << text;
  const std::string command = "python3 -c 'import sys, xml.etree.ElementTree as tree; tree.parse(sys.argv[1])' '" +
                              (folder / "text.xml") + "' 2>/dev/null";
  return std::system(command.c_str()) == 0;
}

/// Everything that the first group of the expression matches, in order.
inline std::vector<std::string> all_matches(const std::string& text, const std::string& expression) {
  const std::regex regex(expression);
  std::vector<std::string> found;
  for (std::sregex_iterator it(text.begin(), text.end(), regex), end; it != end; ++it) found.push_back((*it)[1]);
  return found;
}

/// Addresses that a page loads or leads to and that do not lie within it.
inline std::vector<std::string> outside_references(const std::string& page) {
  std::vector<std::string> outside;
  for (const auto& address : all_matches(page, "(?:src|href|action|data|srcset|poster)=\"([^\"]{0,40})")) {
    if (address.rfind("data:image/", 0) != 0 && address.rfind("#", 0) != 0) outside.push_back(address);
  }
  for (const auto& word : all_matches(page, "(<script|<link|<iframe|<object|@import|url\\()")) outside.push_back(word);
  return outside;
}
