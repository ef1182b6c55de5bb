// What verbs say.
#pragma once

#include <filesystem>
#include <string>

namespace peclet::runner {

// To standard output. A full disk behind `peclet export > file` must not look like success: throws
// std::system_error, with `advice` behind the name.
void print(const std::string& text, const char* advice = "");

// To standard error. What cannot be said, because that is closed or full, changes no exit code.
void say(const std::string& text);

// To the file `output`, whole or not at all, or to standard output where it has no name.
void deliver(const std::string& text, const std::filesystem::path& output, bool quiet);

}  // namespace peclet::runner
