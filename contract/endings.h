// Endings of a realisation that leave a result: engines write them, the runner reads them.
#pragma once

#include <string_view>

namespace peclet {

// To the end, or until it jammed under a stress, after which it counts as standing still. After any other
// ending there are no means.
inline bool has_results(std::string_view cause) { return cause == "completed" || cause == "jammed"; }

// Returns whether a realisation with this cause has jammed: it stood still under its stress, was pressed
// together further than the guard allows, or could not be packed.
inline bool is_jam(std::string_view cause) {
  return cause == "jammed" || cause == "overlap" || cause == "packing";
}

}  // namespace peclet
