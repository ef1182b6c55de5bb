// How the program leaves after an error.
#pragma once

#include <exception>
#include <string>

namespace peclet::runner {

// 2 InputError and names that no file can have, 5 OwnedByAnother, 6 IntegrityError, 1 any other.
int exit_code_of(const std::exception& error);

// What it says, fit for a terminal.
std::string message_of(const std::exception& error);

}  // namespace peclet::runner
