// A database that its owner has made, and not yet filled.
#pragma once

#include "contract/input_error.h"

namespace peclet::runner {

// For whoever can wait, which takes moments.
class BeingSetUp : public InputError {
 public:
  explicit BeingSetUp(
      const std::string& database,
      const std::string& how = "the campaign is only just being set up; try again in a moment")
      : InputError(database, "", "", how) {}
};

}  // namespace peclet::runner
