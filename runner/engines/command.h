// An outside command, run to its end: what it printed and how it left.
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "runner/store/blame.h"

namespace peclet::runner {

struct CommandAnswer {
  ExitStatus ending;
  bool timed_out = false;  // it was killed with its children, and what it did is unknown
  std::string output, errors;
  bool succeeded() const { return !timed_out && ending.status == 0; }
  // Why it did not succeed, on one line: "exit status 1: Unable to contact slurm controller".
  std::string complaint() const;
};

// Runs a program (found on PATH) in a process group of its own, so that a Ctrl-C at the terminal does not cut
// it off between doing something and saying so. Its standard input is `input`. Throws std::system_error if
// the program cannot be started.
CommandAnswer run_command(const std::vector<std::string>& words, std::chrono::seconds patience,
                          const std::string& input = "");

}  // namespace peclet::runner
