// Addresses of the live page: itself at /, what has changed at /state?since=TOKEN (204 if nothing), and more
// of a point at /point?hash=HASH. Everything else is 404; other methods than GET and HEAD are 405; a request
// that calls this machine by a name from elsewhere is 403.
#pragma once

#include <string_view>

#include "runner/live/live_campaign.h"
#include "runner/live/loopback_server.h"

namespace peclet::runner {

// Returns 500 if the database cannot be read; the page shows the fault.
HttpAnswer answer(LiveCampaign& campaign, const HttpRequest& request);

// Returns whether a request calls this machine by a name that only this machine has, at any port, which ssh
// may forward. A page from elsewhere whose name was made to lead here (DNS rebinding) calls it by its own
// name.
bool is_loopback_name(std::string_view host);

}  // namespace peclet::runner
