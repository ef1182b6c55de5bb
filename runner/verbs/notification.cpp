#include "runner/verbs/notification.h"

#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <exception>

#include "contract/printable.h"
#include "runner/engines/command.h"

namespace peclet::runner {
namespace {

std::string failure(const std::string& command, const std::string& why) {
  return printable_lines(fmt::format("--notify: {}: {}", command, why));
}

}  // namespace

std::string notify(const std::string& command, const RunOutcome& outcome) {
  namespace fs = std::filesystem;
  try {
    const CommandAnswer answer =
        run_command({"env", "PECLET_CAMPAIGN=" + fs::absolute(outcome.campaign).string(),
                     "PECLET_DIRECTORY=" + fs::absolute(outcome.directory).string(),
                     fmt::format("PECLET_EXIT_CODE={}", outcome.code),
                     "PECLET_SUMMARY=" + printable(outcome.summary), "/bin/sh", "-c", command},
                    std::chrono::minutes(1));
    if (!answer.succeeded()) return failure(command, answer.complaint());
    std::fputs((answer.output + answer.errors).c_str(), stderr);
    return "";
  } catch (const std::exception& error) {
    return failure(command, error.what());
  }
}

}  // namespace peclet::runner
