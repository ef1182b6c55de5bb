// The result of one realisation as an engine wrote it: checked, and what the runner takes from it.
#pragma once

#include <set>
#include <string>

#include "contract/endings.h"
#include "contract/json.h"
#include "runner/store/result_shape.h"

namespace peclet::runner {

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
