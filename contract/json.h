// JSON as both programs use it: the type, strict reading, and one canonical spelling.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace peclet {

// Object keys are sorted, so equal documents print equally.
using Json = nlohmann::json;

// Parses `text`; duplicate keys, comments and trailing text are refused.
// Throws InputError naming `file` and the line and column of the fault.
Json parse_json(std::string_view text, const std::string& file);

// Reads and parses a file. Throws InputError when it is absent, unreadable or not JSON.
Json read_json(const std::filesystem::path& path);

// The one spelling of a document: sorted keys, no blanks, shortest round-trip numbers, and a number that is
// a whole one below 2^53 written as an integer, so that 1, 1.0 and 1e0 are the same document.
// Throws std::invalid_argument for a number that is not finite.
std::string canonical_json(const Json& document);

}  // namespace peclet
