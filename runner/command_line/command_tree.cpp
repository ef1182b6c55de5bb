#include "runner/command_line/command_tree.h"

#include <algorithm>
#include <iterator>

namespace peclet::runner {
namespace {

std::vector<CommandOption> those(const std::vector<CommandOption>& options, bool positional) {
  std::vector<CommandOption> found;
  std::copy_if(options.begin(), options.end(), std::back_inserter(found),
               [&](const CommandOption& option) { return option.positional == positional; });
  return found;
}

}  // namespace

std::vector<CommandOption> CommandVerb::positionals() const { return those(options, true); }

std::vector<CommandOption> CommandVerb::named() const { return those(options, false); }

}  // namespace peclet::runner
