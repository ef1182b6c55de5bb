// What is to be said of verbs beyond the one line that the list of verbs has: for --help and the manual.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace peclet::runner {

struct VerbExample {
  std::string command;
  std::string purpose;  // may be empty
};

struct VerbPage {
  std::vector<std::string> paragraphs;
  std::vector<VerbExample> examples;  // after the one that the verb itself has
  std::vector<int> exit_codes;        // that it can leave with; empty: any
};

struct VerbText {
  std::string example;
  VerbPage page;
};

// Paragraphs of `prose` are separated by empty lines; where its lines end means nothing.
VerbPage page(const std::string& prose, std::vector<VerbExample> examples, std::vector<int> exit_codes);

const std::map<int, std::string>& exit_codes();

// What follows the options in --help.
std::string help_footer(const VerbPage& page, const std::string& example);

}  // namespace peclet::runner
