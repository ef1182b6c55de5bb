// The verb `peclet completion`: what shells need to complete command lines of peclet.
#pragma once

#include <filesystem>
#include <string>

#include "runner/command_line/command_tree.h"

namespace peclet::runner {

struct CompletionOptions {
  std::string shell;             // bash, zsh or fish
  std::filesystem::path output;  // "": standard output
  bool quiet = false;            // does not say where it is
};

// A script for `eval`, or for a file in the shell's own folder of completions. Verbs, options, choices, and
// files where an option takes some: campaign files (*.json), .peclet folders, any file, any folder.
std::string bash_completion(const CommandTree& tree);
std::string zsh_completion(const CommandTree& tree);
std::string fish_completion(const CommandTree& tree);

std::string completion(const CommandTree& tree, const std::string& shell);

}  // namespace peclet::runner
