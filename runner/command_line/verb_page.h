// What --help, and so the manual, says of verbs beyond the one line that the list of verbs has.
#pragma once

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

// Paragraphs of `prose` are separated by empty lines; where its lines end means nothing.
VerbPage page(const std::string& prose, std::vector<VerbExample> examples, std::vector<int> exit_codes);

// A line for each of these exit codes, below a heading; for all of them if there are none.
std::string exit_code_lines(const std::vector<int>& codes);

// What follows the options in --help.
std::string help_footer(const VerbPage& page, const std::string& example);

}  // namespace peclet::runner
