// What people call keys of a scene: the one list of it, for the page and for figures.
#pragma once

#include <string>
#include <string_view>

namespace peclet::runner {

struct KeyName {
  std::string_view words, symbol;  // the symbol as results write theirs: "mu_r"
};

// Null for a key that has only its own name.
const KeyName* key_name(const std::string& pointer);

}  // namespace peclet::runner
