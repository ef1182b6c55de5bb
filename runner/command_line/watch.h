// The verbs `peclet watch` and `peclet serve`: the status kept up to date, in a terminal or a browser.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace peclet::runner {

struct WatchOptions {
  std::filesystem::path campaign;  // file or folder
  std::filesystem::path directory;
  double interval_seconds = 2;
};

// Shows the status until every point is decided or Ctrl-C is pressed, also while no process runs the
// campaign. If standard output is not a terminal, prints each state once when it has changed. Waits for the
// first run of a campaign file that has not been run. Returns the exit code of `status --check`. Throws as
// open_campaign() if the campaign does not exist.
int watch_campaign(const WatchOptions& options);

// Returns the text as far as a terminal shows it without scrolling or folding: at most `rows` lines of at
// most `columns` characters (a UTF-8 sequence counts as one). A line that is cut ends with …; if lines are
// left out, the last line says how many.
std::string fitted(std::string_view text, int rows, int columns);

struct ServeOptions {
  std::filesystem::path campaign;  // file or folder
  std::filesystem::path directory;
  int port = 7325;  // 0: any that is free
};

// Prints the address and serves the page until a signal comes. Waits for the first run of a campaign file.
// Returns the exit code of `status --check`. Throws as open_campaign() and LoopbackServer.
int serve_campaign(const ServeOptions& options);

}  // namespace peclet::runner
