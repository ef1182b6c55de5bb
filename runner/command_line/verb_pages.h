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

// An empty page for a verb that one line says everything about.
const VerbPage& verb_page(const std::string& verb);

const std::map<int, std::string>& exit_codes();

// What follows the options in --help.
std::string help_footer(const std::string& verb, const std::string& example);

}  // namespace peclet::runner
