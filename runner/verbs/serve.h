// The verb `peclet serve`: the page of a campaign in a browser of this machine, kept up to date.
#pragma once

#include <filesystem>

namespace peclet::runner {

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
