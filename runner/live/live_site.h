// What there is to be asked of the live page: itself at /, what has changed at /state?since=TOKEN (204:
// nothing), and more of a point at /point?hash=HASH. Everything else is 404; other methods than GET and HEAD
// are 405; a request that calls this machine by a name from elsewhere is 403.
#pragma once

#include "runner/live/http_answer.h"
#include "runner/live/http_request.h"
#include "runner/live/live_campaign.h"

namespace peclet::runner {

// What the database makes impossible is told to the page, and is 500 here.
HttpAnswer answer(LiveCampaign& campaign, const HttpRequest& request);

}  // namespace peclet::runner
