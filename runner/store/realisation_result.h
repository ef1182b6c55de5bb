// RealisationResult is the checked result of one realisation: its text as an engine wrote it, and what the
// runner takes from it.
#pragma once

#include <cstddef>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>

#include "contract/frames.h"
#include "contract/json.h"

namespace peclet::runner {

// Bounds on the text of a result. They are checked before it is read as JSON, which takes memory in
// proportion. Most results have some ten thousand bytes and a few thousand values; a pair distribution in the
// plane of shear may have four million numbers. Lists, objects and keys take more memory than numbers do.
constexpr std::size_t largest_result = std::size_t{64} << 20;
constexpr std::size_t most_values = std::size_t{1} << 22;
constexpr std::size_t most_structures = std::size_t{1} << 19;
constexpr int deepest_result = 200;

// Returns which bound the text exceeds; "" if it keeps within them. It need not be JSON.
std::string excess_of(std::string_view text);

// Thrown if a text is not a valid result; what() is one short line, whatever the text holds. Results come
// from outside: an engine may lie, and any file may lie in the spool. Every fault is found before anything is
// stored, so code that takes a RealisationResult need not check it again.
class ResultError : public std::runtime_error {
 public:
  explicit ResultError(const std::string& message);
};

// Returns the part of a result at the pointer `root`, such as "/engine". Throws ResultError if it does not
// match its keys.
Json checked_part(Json part, const std::string& root);

// Returns engine version, instruction set and hash of the binary, which all results of a point share. Throws
// ResultError if one of the three is missing or invalid.
std::string engine_identity(const Json& engine);

struct RealisationResult {
  std::string text;  // the engine's text without white space
  Json document;     // the text as JSON
  std::string point;
  int seed = 0;
  std::string cause;           // cause of the ending: "completed", "overlap", ...
  std::string engine;          // engine_identity()
  std::string content_sha256;  // hash of what repetitions must share
  bool completed() const { return has_results(cause); }
};

// Reads the text of a result. Throws ResultError naming what is wrong.
RealisationResult parse_result(std::string text);

// Returns the warning codes of a completed result, without those that follow from the scene alone
// ("inertia-..."), which `validate` shows.
std::set<std::string> flags_of(const RealisationResult& result);

}  // namespace peclet::runner
