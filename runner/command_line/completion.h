// The verb `peclet completion`: what bash needs to complete command lines of peclet.
#pragma once

#include <filesystem>
#include <string>

#include "runner/command_line/command_tree.h"

namespace peclet::runner {

struct CompletionOptions {
  std::string shell;             // bash
  std::filesystem::path output;  // "": standard output
  bool quiet = false;            // does not say where it is
};

// A script for `eval`, or for a file in bash's own folder of completions. Verbs, options, choices, and files
// where an option takes some: campaign files (*.json), .peclet folders, any file, any folder.
std::string bash_completion(const CommandTree& tree);

}  // namespace peclet::runner
