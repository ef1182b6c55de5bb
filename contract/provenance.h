// Where a program comes from: what is needed to build it again.
#pragma once

#include <string>

#include "contract/json.h"

namespace peclet {

// "0.2.0"
std::string version();

// {"version", "git_commit", "git_dirty", "binary_sha256", "compiler", "flags", "build_type", "cpu"} of the
// running program. binary_sha256 is of /proc/self/exe as it was at the first call.
const Json& provenance();

}  // namespace peclet
