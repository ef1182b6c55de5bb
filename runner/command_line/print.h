// Output of verbs, and their exit codes.
#pragma once

#include <exception>
#include <filesystem>
#include <string>
#include <vector>

#include "runner/owner/open_campaign.h"

namespace peclet::runner {

// Writes the text to standard output. Throws std::system_error if that fails, so that a full disk behind
// `peclet export > file` is an error; its message is "standard output" and `advice`.
void print(const std::string& text, const char* advice = "");

// Writes the text to standard error. A failure is ignored and changes no exit code.
void say(const std::string& text);

// Writes the text to the file `output`, whole or not at all, or to standard output if `output` is empty.
// Unless `quiet`, says on standard error where the file is.
void deliver(const std::string& text, const std::filesystem::path& output, bool quiet);

// Returns the exit code after an error: 2 for InputError and names that no file can have, 5 for
// OwnedByAnother, 6 for IntegrityError, 1 for any other.
int exit_code_of(const std::exception& error);

// Returns the message of an error, without characters that would control a terminal.
std::string message_of(const std::exception& error);

// Opens a campaign as open_campaign(), for a verb that only reads it. Says on standard error if the database
// is read without the locks and the log of a running campaign, because this user may not write it.
OpenCampaign open_for_viewing(const std::filesystem::path& given, const std::filesystem::path& chosen);

// Opens further campaigns that are shown with the first one. Throws InputError at --with if two have one
// name, which tells their points apart.
std::vector<OpenCampaign> open_beside(OpenCampaign& first, const std::vector<std::filesystem::path>& others);

}  // namespace peclet::runner
