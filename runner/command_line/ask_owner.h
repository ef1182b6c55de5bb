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

// The text that a verb prints, and its exit code.
struct Reply {
  std::string text;
  int exit_code = 0;
};

// Default time that a verb waits for a running owner [s].
constexpr double usual_patience = 60;

// Waits until a written request is carried out: by the campaign's owner, at most for `patience` seconds (0:
// not at all), or by this process if there is no owner. Returns a text that says what was done and which
// command comes next; commands name the campaign by `words`. The exit code is 4 if a `patience` > 0 was too
// short, otherwise 0. Throws InputError with the reason if the request is refused.
Reply await_reply(const CampaignDirectory& directory, const Request& request, const std::string& words,
                  double patience);

struct SetOptions {
  std::filesystem::path campaign;
  std::filesystem::path directory;
  std::optional<double> tolerance, absolute_tolerance, confidence;  // in /target
  std::optional<int> minimum, maximum;                              // in /realisations
  std::optional<int> realisations;                                  // /realisations, where it is a number
  std::optional<std::string> keep_files;                            // /keep_files, as a word
  std::vector<std::string> points;                                  // those that get the priority
  std::optional<int> priority;
  double patience = usual_patience;
};

// Changes these values in the text of the campaign file, leaves every other byte, and has the campaign take
// the file over; a later `peclet run` therefore undoes nothing. If the campaign has not been run, only the
// file changes. A priority is not part of the file. Throws InputError, with nothing written, for a file that
// `peclet run` would refuse. Otherwise returns and throws as await_reply().
Reply set_campaign(const SetOptions& options);

struct CancelOptions {
  std::filesystem::path campaign;  // file or folder
  std::filesystem::path directory;
  std::vector<std::string> points;  // labels, or at least 4 digits of the hash
  bool undo = false;
  double patience = usual_patience;
};

// Gives the points no more seeds. Their running seeds save a checkpoint and stop; results stay. With `undo`
// the points get seeds again and continue where they were. Throws InputError for a campaign that has not been
// run. Otherwise returns and throws as await_reply().
Reply cancel_points(const CancelOptions& options);

struct RetryOptions {
  std::filesystem::path campaign;  // file or folder
  std::filesystem::path directory;
  std::vector<std::string> points;  // labels, or at least 4 digits of the hash; empty: all
  std::vector<int> seeds;           // seeds of one point; empty: all that were given up
  double patience = usual_patience;
};

// Queues seeds that were given up; their earlier attempts no longer count. Throws InputError for a campaign
// that has not been run and a seed that was not given up. Otherwise returns and throws as await_reply().
Reply retry_seeds(const RetryOptions& options);

}  // namespace peclet::runner
