// RequestHandler carries out what people ask of a running campaign. Each request is carried out once, even if
// a process is killed: the event that records it names the request and is committed with its effects.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "runner/campaign/paths.h"
#include "runner/owner/campaign_state.h"
#include "runner/owner/request.h"
#include "runner/owner/run_listener.h"
#include "runner/store/campaign_directory.h"
#include "runner/store/database.h"

namespace peclet::runner {

// Returns the index of the named point: by its label, or else as the only point with these values ("10 0.5",
// as in a row of a table) or with these 4 or more leading digits of its hash. Throws InputError if no point,
// or more than one, matches.
std::size_t find_point(const std::vector<PointRecord>& points, const std::string& name);

class RequestHandler {
 public:
  // All references must outlive it.
  RequestHandler(Database& database, CampaignState& state, CampaignDirectory directory, RunListener& listener)
      : database_(database), state_(state), directory_(std::move(directory)), listener_(listener) {}

  bool any_waits() const { return !waiting_requests(directory_).empty(); }

  // Carries out the waiting requests, each in a transaction of its own. A request that cannot be carried out
  // becomes an event `refused` with the reason; a file that is not a request is set aside with a warning.
  // Returns true if the state was read again: the seeds that workers have then need
  // CampaignState::find_place(). Throws DatabaseError: the request still waits, and the state was read again.
  bool carry_out();

 private:
  void carry_out(const Request& request);
  // Kind of the event, message for people, and the point if there is a single one.
  struct Done {
    std::string kind, message;
    std::optional<std::int64_t> point{};
  };
  Done apply(const TakeOver& wish);
  Done apply(const Prioritise& wish);
  Done apply(const Cancel& wish);
  Done apply(const Retry& wish);

  Database& database_;
  CampaignState& state_;
  CampaignDirectory directory_;
  RunListener& listener_;
  std::set<fs::path> left_alone_;  // files that are not requests and could not be set aside
};

}  // namespace peclet::runner
