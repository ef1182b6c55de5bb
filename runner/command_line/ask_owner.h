// The verbs that change what a campaign is to do, also while it runs: `peclet set`, `peclet cancel` and
// `peclet retry`. They ask the campaign's owner and wait for it.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "runner/owner/request.h"
#include "runner/store/campaign_directory.h"

namespace peclet::runner {

// The verbs' side of requests: wait for the campaign's owner, or be the owner for as long as it takes.
//
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

// The verb `peclet set`: another target, other points, other priorities.
struct SetOptions {
  std::filesystem::path campaign;
  std::filesystem::path directory;
  std::optional<double> tolerance, absolute_tolerance, confidence;  // of /target
  std::optional<int> minimum, maximum;                              // of /realisations
  std::optional<int> realisations;                                  // /realisations, where it is a number
  std::optional<std::string> keep_files;                            // /keep_files, as a word
  std::vector<std::string> points;                                  // whose priority is set
  std::optional<int> priority;
  double patience = usual_patience;
};

// Changes these values in the text of the campaign file, of which nothing else changes, and has the campaign
// take the file over as it is then: the file stays what counts, and a later `peclet run` undoes nothing. A
// campaign that has not been run is changed in its file alone. A priority is no part of the file. Throws
// InputError, with nothing written, for a file that `peclet run` would refuse; as await_reply().
Reply set_campaign(const SetOptions& options);

// The verb `peclet cancel`: points that get no more seeds.
struct CancelOptions {
  std::filesystem::path campaign;  // file or folder
  std::filesystem::path directory;
  std::vector<std::string> points;  // labels, or at least 4 digits of the hash
  bool undo = false;
  double patience = usual_patience;
};

// The points' running seeds checkpoint and stop, what they have stays, and they hold nothing up; with `undo`
// they go on where they were. Throws InputError for a campaign that has not been run; as await_reply().
Reply cancel_points(const CancelOptions& options);

// The verb `peclet retry`: seeds that were given up get another chance.
struct RetryOptions {
  std::filesystem::path campaign;  // file or folder
  std::filesystem::path directory;
  std::vector<std::string> points;  // labels, or at least 4 digits of the hash; none: all
  std::vector<int> seeds;           // of one point; none: all that were given up
  double patience = usual_patience;
};

// Queues them again; their earlier attempts are kept, but no longer count against them. Throws InputError for
// a campaign that has not been run; as await_reply(), and for a seed that was not given up.
Reply retry_seeds(const RetryOptions& options);

}  // namespace peclet::runner
