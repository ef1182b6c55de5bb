// The verbs' side of requests: wait for the campaign's owner, or be the owner for as long as it takes.
#pragma once

#include <filesystem>
#include <string>

#include "runner/requests/request.h"
#include "runner/store/campaign_directory.h"

namespace peclet::runner {

// How a verb ends: what it prints and its exit code.
struct Reply {
  std::string text;
  int exit_code = 0;
};

// Seconds that a verb waits for a running owner unless told otherwise.
constexpr double usual_patience = 60;

// Sees to it that a request that has been written is carried out: by the process that owns the campaign,
// which is waited for as long as `patience` seconds (0: not at all), or by this one when nobody owns it. The
// text says what was done and what comes next, in commands that name the campaign by `words`; exit code 4
// when the owner has not come to it in time, 0 otherwise. Throws InputError with the reason when it is
// refused.
Reply await_reply(const CampaignDirectory& directory, const Request& request, const std::string& words,
                  double patience);

}  // namespace peclet::runner
