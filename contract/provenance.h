// Provenance of the running program: what is needed to build it again.
#pragma once

#include <string>

#include "contract/json.h"

namespace peclet {

// Returns the version, such as "0.2.0".
std::string version();

// Returns {"version", "git_commit", "git_dirty", "binary_sha256", "compiler", "flags", "build_type", "cpu"}
// of the running program. binary_sha256 is the hash of /proc/self/exe at the first call.
const Json& provenance();

}  // namespace peclet
