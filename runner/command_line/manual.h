// The verb `peclet manual`: pages for man(1), from the command line's own verbs and options.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "runner/command_line/command_tree.h"

namespace peclet::runner {

struct ManualOptions {
  std::string verb;              // "": of peclet itself
  std::filesystem::path folder;  // for all pages; "": one, to standard output
};

// A page in roff with the macros of man(7), in ASCII. `verb` is empty for that of peclet itself.
// Throws InputError for a verb that there is not.
std::string manual_page(const CommandTree& tree, const std::string& verb);

// All pages by the name of their file: "peclet.1", "peclet-run.1".
std::map<std::string, std::string> manual_pages(const CommandTree& tree);

}  // namespace peclet::runner
