// Campaign files: which one a person means, and one value of it replaced.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "contract/json.h"

namespace peclet::runner {

// Finding the campaign file that a person means.
//
// The campaign file beside a campaign's folder, as it is spelt from here; a file is itself.
std::filesystem::path campaign_file_of(const std::filesystem::path& given);

// Throws InputError when there is no such file, or a folder, and says which file may have been meant.
void require_campaign_file(const std::filesystem::path& given);

// The folder at which relative paths of a campaign start and in which its engine runs: the file's, or the
// present one where a pipe has been given.
std::filesystem::path home_of(const std::filesystem::path& campaign_file);

// What names the campaign in a command that a person is to type, quoted for the shell where it must be:
// "flow-curve.json", and "flow-curve.json --directory FOLDER" where a folder has been chosen.
std::string words_for(const std::filesystem::path& campaign_file, const std::filesystem::path& chosen);

// "; did you mean FILE?" for a name like that of a campaign file or folder beside it, or nothing.
std::string similar_name(const std::filesystem::path& given);

// One value of a JSON text replaced, and nothing else: the author's order, blanks and spelling stay.
//
// The text in which the value at `path` (keys of nested objects, all but the last of which must exist) is
// `value`: its token is replaced, or the key is put behind the last one of its object, spaced as the first
// one is. Requires a text that parse_json() has read.
std::string with_value(const std::string& text, const std::vector<std::string>& path, const Json& value);

}  // namespace peclet::runner
