// An engine that is of no use.
#pragma once

#include <stdexcept>

namespace peclet::runner {

// An engine that does not start, or does not live until it is given work. Exit code 1.
class EngineError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace peclet::runner
