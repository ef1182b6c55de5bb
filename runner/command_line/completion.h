// Completion of command lines, read off the parser's own verbs and options so that it cannot say anything
// else.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace peclet::runner {

// Names of the values of options; completion offers files by them.
namespace value_name {
constexpr const char* campaign_file = "FILE.json";
constexpr const char* campaign = "CAMPAIGN";  // a campaign file, or its .peclet folder
constexpr const char* file = "FILE";
constexpr const char* folder = "FOLDER";
}  // namespace value_name

// Prints values without the parser's own words for their checks: "--threads NUMBER=1".
class HelpFormatter : public CLI::Formatter {
 public:
  std::string make_option_opts(const CLI::Option* option) const override;
};

// Returns a script of bash for `eval`, or for a file in bash's own folder of completions. It offers verbs,
// options, choices, and files where an option takes some: campaign files (*.json), .peclet folders, any file,
// any folder.
std::string bash_completion(const CLI::App& app);

}  // namespace peclet::runner
