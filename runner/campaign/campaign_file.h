// Finds the campaign file that a user means, and replaces single values in it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "contract/json.h"

namespace peclet::runner {

// Returns the campaign file beside a campaign's folder, NAME.json for NAME.peclet; returns a file as it is.
std::filesystem::path campaign_file_of(const std::filesystem::path& given);

// Throws InputError if the file does not exist or is a folder, and names the file that may have been meant.
void require_campaign_file(const std::filesystem::path& given);

// Returns the folder at which relative paths of a campaign start and in which its engine runs: the file's, or
// the current one if the campaign comes from a pipe.
std::filesystem::path home_of(const std::filesystem::path& campaign_file);

// Returns the words that name the campaign in a command, quoted for the shell: "flow-curve.json", or
// "flow-curve.json --directory FOLDER" if the user chose a folder.
std::string words_for(const std::filesystem::path& campaign_file, const std::filesystem::path& chosen);

// Returns "; did you mean FILE?" if a campaign file or folder beside it has a similar name, or "".
std::string similar_name(const std::filesystem::path& given);

// Returns the text with `value` at `path`, the keys of nested objects. Only this token changes: the author's
// order, blanks, comments and spelling stay. An absent last key is added behind the others of its object,
// spaced as the first one. Throws std::invalid_argument if another key is absent. Requires a text that is
// valid JSON but for comments.
std::string with_value(const std::string& text, const std::vector<std::string>& path, const Json& value);

}  // namespace peclet::runner
