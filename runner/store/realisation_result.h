// The result of one realisation as an engine wrote it: checked, and what the runner takes from it.
#pragma once

#include <cstddef>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>

#include "contract/frames.h"
#include "contract/json.h"

namespace peclet::runner {

// How large the text of a result may be: judged before it is read as JSON, which takes memory in proportion.
// Most have some ten thousand bytes and a few thousand values; a pair distribution in the
// plane of shear may have four million numbers. Lists, objects and keys take more memory than numbers do.
constexpr std::size_t largest_result = std::size_t{64} << 20;
constexpr std::size_t most_values = std::size_t{1} << 22;
constexpr std::size_t most_structures = std::size_t{1} << 19;
constexpr int deepest_result = 200;

// "" when the text keeps within these bounds, otherwise what it exceeds. It need not be JSON.
std::string excess_of(std::string_view text);

// Checks of a result before anything of it is stored: result_keys(), and what no table of keys can say.
//
// Results come from outside: an engine may lie, and a file may have been put where results are looked for.
// Whatever is wrong with one is found here, in one go and without a trace; who takes a result that has passed
// need not ask again.
//
// A text that is no result. What it says is one short line, whatever the text holds.
class ResultError : public std::runtime_error {
 public:
  explicit ResultError(const std::string& message);
};

// Returns the part of a result at the pointer `root`, such as "/engine". Throws ResultError if it does not
// match its keys.
Json checked_part(Json part, const std::string& root);

// Engine version, instruction set and hash of the binary: results of one point share it.
// Throws ResultError when one of the three is missing or none.
std::string engine_identity(const Json& engine);

struct RealisationResult {
  std::string text;  // as the engine wrote it, but for white space
  Json document;     // the same, read
  std::string point;
  int seed = 0;
  std::string cause;           // of the ending: "completed", "overlap", ...
  std::string engine;          // engine_identity()
  std::string content_sha256;  // of what repetitions must share
  bool completed() const { return has_results(cause); }
};

// Reads the text of a result. Throws ResultError naming what is wrong.
RealisationResult parse_result(std::string text);

// Warning codes of a completed result, without those that the scene alone implies ("inertia-..."), which
// `validate` shows.
std::set<std::string> flags_of(const RealisationResult& result);

}  // namespace peclet::runner
