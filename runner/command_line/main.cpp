// peclet: campaigns of realisations, from scenes to converged averages.
#include <fmt/format.h>

#include <exception>

#include "runner/command_line/options.h"
#include "runner/command_line/print.h"

int main(int argc, char** argv) {
  using namespace peclet::runner;
  try {
    const CommandLine command = read_command_line(argc, argv);
    return command.action ? command.action() : command.exit_code;
  } catch (const std::exception& error) {
    say(fmt::format("peclet: {}\n", message_of(error)));
    return exit_code_of(error);
  }
}
