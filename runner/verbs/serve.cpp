#include "runner/verbs/serve.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <system_error>

#include "contract/printable.h"
#include "runner/engines/stop_signals.h"
#include "runner/live/live_campaign.h"
#include "runner/live/live_site.h"
#include "runner/live/loopback_server.h"

namespace peclet::runner {

int serve_campaign(const ServeOptions& options) {
  StopSignals signals;
  LiveCampaign campaign(options.campaign, options.directory);
  LoopbackServer server(options.port);
  fmt::print("http://127.0.0.1:{}/\n", server.port());
  if (std::fflush(stdout) != 0) throw std::system_error(errno, std::generic_category(), "standard output");
  fmt::print(stderr, "peclet: the page of {} is there; Ctrl-C ends it, and does nothing to the campaign\n",
             printable(campaign.name()));
  server.serve(signals.descriptor(), [&](const HttpRequest& request) { return answer(campaign, request); });
  campaign.look();
  return campaign.standing();
}

}  // namespace peclet::runner
