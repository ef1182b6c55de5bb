// The command tree of a parser, and how the parser prints its options.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "runner/command_line/command_tree.h"

namespace peclet::runner {

CommandTree describe(const CLI::App& app);

// Prints values without the parser's own words for their checks: "--threads NUMBER=1".
class HelpFormatter : public CLI::Formatter {
 public:
  std::string make_option_opts(const CLI::Option* option) const override;
};

}  // namespace peclet::runner
