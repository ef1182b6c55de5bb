// How the program leaves after an error.
#pragma once

#include <exception>

namespace peclet::runner {

// 2 InputError, 5 OwnedByAnother, 6 IntegrityError, 1 any other.
int exit_code_of(const std::exception& error);

}  // namespace peclet::runner
