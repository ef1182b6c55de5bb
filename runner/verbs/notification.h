// The command of the user's that a run calls when it has ended.
#pragma once

#include <filesystem>
#include <string>

namespace peclet::runner {

struct RunOutcome {
  std::filesystem::path campaign, directory;
  int code = 0;         // the exit code that follows
  std::string summary;  // one line
};

// Runs `command` by /bin/sh, with nothing on its standard input and what it says on standard error, and waits
// for it, a minute at most. It is told what has ended by the variables PECLET_CAMPAIGN (the file) and
// PECLET_DIRECTORY, absolute paths, PECLET_EXIT_CODE and PECLET_SUMMARY. Returns why it failed, on one line;
// nothing where it succeeded.
std::string notify(const std::string& command, const RunOutcome& outcome);

}  // namespace peclet::runner
