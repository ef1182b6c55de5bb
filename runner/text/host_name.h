// What this machine calls itself.
#pragma once

#include <string>

namespace peclet::runner {

// "unknown" where it has no name.
std::string host_name();

}  // namespace peclet::runner
