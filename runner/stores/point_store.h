// The campaign and its points: what a campaign file means for a database that may have seen earlier versions
// of it.
#pragma once

#include <cstdint>
#include <string>

#include "runner/database/database.h"
#include "runner/stores/event_log.h"

namespace peclet::runner {

class PointStore {
 public:
  // Requires a Database of open_owner, which must outlive it. adopt() commits by itself; the others are for
  // use inside a Transaction of the caller.
  explicit PointStore(Database& database)
      : database_(database), connection_(database.connection()), events_(connection_) {}

  // Makes the database that of `campaign`: its points in their order, its target. Points that are no longer
  // in the sweep stay, inactive. Throws InputError, with nothing written, when finished realisations lack the
  // observable.
  void adopt(const Campaign& campaign);
  // The same within the caller's transaction, which is to be rolled back when it throws.
  void take_over(const Campaign& campaign);
  void set_priority(std::int64_t point, int priority);
  void set_cancelled(std::int64_t point, bool cancelled);
  // The point's results stay as they are, but no longer are the campaign's: a row of its own takes its place
  // in the sweep, that of `engine` when there has been one.
  void keep_apart(const PointRecord& point, const std::string& engine);

 private:
  std::int64_t adopt_target(const Campaign& campaign);
  void adopt_points(const Campaign& campaign);
  void observe_again(const Campaign& campaign);

  Database& database_;
  Connection& connection_;
  EventLog events_;
};

}  // namespace peclet::runner
