// What calls of the system give back.
#pragma once

#include <system_error>

namespace peclet::runner {

// Throws std::system_error, which names what was being done, unless `error` is 0.
inline void check(int error, const char* doing) {
  if (error != 0) throw std::system_error(error, std::generic_category(), doing);
}

}  // namespace peclet::runner
