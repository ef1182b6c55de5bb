// The command line of `peclet`, read.
#pragma once

#include <functional>

namespace peclet::runner {

struct CommandLine {
  std::function<int()> action;  // gives an exit code; nothing: there is nothing left to do but to leave with
  int exit_code = 0;            // 0 after help or version, 2 after a fault, both printed already
};

CommandLine read_command_line(int argc, char** argv);

}  // namespace peclet::runner
