// The verb `peclet init`: campaigns to begin with.
#pragma once

#include <filesystem>
#include <map>
#include <string>

namespace peclet::runner {

// The files in docs/examples, which are compiled in: docs/examples/reversal.json is "examples-reversal". Each
// is a campaign that runs as it is. It begins with comments: a line that says what it is, and after an empty
// one what to change and how to draw it. Files that such a campaign needs have the names of other folders:
// docs/examples/files/trap.py is "files-trap".
const std::map<std::string, std::string>& example_texts();

struct InitOptions {
  std::filesystem::path campaign;    // file to write
  std::string example = "friction";  // name of an example
  bool list = false;                 // list the examples, and write nothing
};

// Writes an example under the name of its new file, and beside it the files that its engine needs. Returns
// the message with the next commands, or the list. Throws InputError if one of the files exists, if the name
// cannot be that of a campaign, or if there is no such example; std::system_error if writing fails.
std::string init_campaign(const InitOptions& options);

}  // namespace peclet::runner
