// Endings of a realisation that leave a result: engines write them, the runner reads them.
#pragma once

#include <string_view>

namespace peclet {

// To the end, or until it jammed under a stress, after which it counts as standing still. After any other
// ending there are no means.
inline bool has_results(std::string_view cause) { return cause == "completed" || cause == "jammed"; }

}  // namespace peclet
