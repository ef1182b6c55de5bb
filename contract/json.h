// The JSON type of both programs, its strict parser, and its canonical text.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace peclet {

// Object keys are sorted, so that equal documents have equal texts.
using Json = nlohmann::json;

// Parses `text`. Throws InputError naming `file` and the line and column of the fault; duplicate keys,
// comments and trailing text are faults.
Json parse_json(std::string_view text, const std::string& file);

// Returns JSON in which comments, // to the end of the line and /* to */, have been replaced by blanks, also
// the line breaks in them. Every other byte keeps its place.
std::string without_comments(std::string text);

// Reads and parses a file. Throws InputError if it is absent, unreadable or not JSON.
Json read_json(const std::filesystem::path& path);

// Returns the canonical text of a document: sorted keys, no blanks, shortest round-trip numbers. Whole
// numbers below 2^53 are written as integers, so that 1, 1.0 and 1e0 give one text. Throws
// std::invalid_argument if a number is not finite.
std::string canonical_json(const Json& document);

}  // namespace peclet
