// What is stored, or what an engine says about it, is not what this program may go on with.
#pragma once

#include <stdexcept>

namespace peclet {

// Programs print what() and leave with exit code 6.
class IntegrityError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace peclet
