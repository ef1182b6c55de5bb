// The verbs `peclet watch` and `peclet serve`: the status kept up to date, in a terminal or a browser.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace peclet::runner {

// The verb `peclet watch`: the status in a terminal, kept up to date.
struct WatchOptions {
  std::filesystem::path campaign;  // file or folder
  std::filesystem::path directory;
  double interval_seconds = 2;
};

// Shows the status until every point is decided or somebody presses Ctrl-C; a campaign that nobody runs is
// shown all the same, because its owner may come back. Off a terminal each state is printed once, whole, when
// it has changed. A campaign file that nothing has been run of yet is waited for. The exit code is that of
// `status --check`. Throws as open_campaign() when there is no such campaign.
int watch_campaign(const WatchOptions& options);

// As much of the text as a terminal shows without scrolling or folding: the first `rows` lines, each at most
// `columns` characters long (UTF-8 sequences count as one); what is cut is marked by … or by a last line that
// says how many more there are.
std::string fitted(std::string_view text, int rows, int columns);

// The verb `peclet serve`: the page of a campaign in a browser of this machine, kept up to date.
struct ServeOptions {
  std::filesystem::path campaign;  // file or folder
  std::filesystem::path directory;
  int port = 7325;  // 0: any that is free
};

// Prints the address and answers until a signal comes. Leaves with what `status --check` would. A campaign
// file that nothing has been run of yet is waited for. Throws as open_campaign() when there is no such
// campaign, and as LoopbackServer.
int serve_campaign(const ServeOptions& options);

}  // namespace peclet::runner
