// What people ask for, carried out by the campaign's owner: once each, whatever is killed when, because the
// event that says what was done names its request and is committed together with it.
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

// Returns the index of the point that people name so: by its label, or else the only one with these values
// ("10 0.5", as in the row of a table) or with those 4 or more leading digits of its hash. Throws InputError
// for a name that no point, or more than one, has.
std::size_t find_point(const std::vector<PointRecord>& points, const std::string& name);

class RequestHandler {
 public:
  // All references must outlive it.
  RequestHandler(Database& database, CampaignState& state, CampaignDirectory directory, RunListener& listener)
      : database_(database), state_(state), directory_(std::move(directory)), listener_(listener) {}

  bool any_waits() const { return !waiting_requests(directory_).empty(); }

  // Carries out what waits, each request in a transaction of its own. One that cannot be carried out becomes
  // an event `refused` that says why; a file that is no request is set aside with a warning. True when the
  // state's picture was taken again: the seeds that workers have are then to be found again. Throws
  // DatabaseError: the request it came with waits on, and the state's picture was taken again.
  bool carry_out();

 private:
  void carry_out(const Request& request);
  // The kind of event that says so, the point when it is a single one, and in words what was done.
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
  std::set<fs::path> left_alone_;  // no requests, and could not be set aside
};

}  // namespace peclet::runner
