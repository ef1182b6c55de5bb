// How a process ended.
#pragma once

#include <optional>
#include <string>

namespace peclet::runner {

struct ExitStatus {
  std::optional<int> status;  // of exit()
  std::optional<int> signal;  // that killed it
};

// "exit status 3", "signal 11 (Segmentation fault)"
std::string to_string(const ExitStatus& ending);
// Of what waitpid(2) says about a process that has ended.
ExitStatus exit_status(int wait_status);

}  // namespace peclet::runner
