// What verbs print, and the exit codes with which they leave.
#pragma once

#include <exception>
#include <filesystem>
#include <string>

#include "runner/owner/open_campaign.h"

namespace peclet::runner {

// What verbs say.
//
// To standard output. A full disk behind `peclet export > file` must not look like success: throws
// std::system_error, with `advice` behind the name.
void print(const std::string& text, const char* advice = "");

// To standard error. What cannot be said, because that is closed or full, changes no exit code.
void say(const std::string& text);

// To the file `output`, whole or not at all, or to standard output where it has no name.
void deliver(const std::string& text, const std::filesystem::path& output, bool quiet);

// How the program leaves after an error.
//
// 2 InputError and names that no file can have, 5 OwnedByAnother, 6 IntegrityError, 1 any other.
int exit_code_of(const std::exception& error);

// What it says, fit for a terminal.
std::string message_of(const std::exception& error);

// Opening a campaign for a verb that only looks at it.
//
// As open_campaign(); says on standard error if the database is read as it is, without the locks and the log
// that a running campaign has.
OpenCampaign open_for_viewing(const std::filesystem::path& given, const std::filesystem::path& chosen);

}  // namespace peclet::runner
