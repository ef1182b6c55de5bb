// What has become of every seed: the scheduler's picture, the database and the spool, kept in step.
//
// The writing functions run inside a Transaction of the caller; what must happen only after its commit is
// kept until after_commit(). So whatever is killed when, database and spool together know every result, once.
//
// There is one way back from what fails: what was to follow the commit is dropped, and the picture is taken
// from the database again, which has rolled back by itself. roll_back() does so for a transaction, and
// take_whole() for a single result within one.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "contract/errors.h"
#include "runner/campaign/paths.h"
#include "runner/engines/worker_process.h"
#include "runner/owner/after_commit.h"
#include "runner/owner/point_states.h"
#include "runner/owner/run_listener.h"
#include "runner/store/campaign_directory.h"
#include "runner/store/point_store.h"
#include "runner/store/result_store.h"
#include "runner/store/seed_store.h"

namespace peclet::runner {

// Points with results of one engine are to be run with another. what() names both.
class OtherEngine : public IntegrityError {
 public:
  using IntegrityError::IntegrityError;
};

// A seed that has been given to a worker.
struct GivenSeed {
  SeedId id;  // its place is `nowhere` when the point has left the sweep since
  std::int64_t point_id = 0;
  Job job;
};

class CampaignState {
 public:
  // Requires that the database has adopted the campaign. Takes in what earlier runs left in the spool, then
  // puts the seeds of a dead owner back. All references must outlive the state.
  CampaignState(Database& database, const Campaign& campaign, CampaignDirectory directory,
                RunListener& listener, int retries);

  // From now on. With a budget seeds go where they lower the summed relative error most, without one to the
  // point that will take longest.
  void set_bounds(Bounds bounds);

  // Takes in every spool file that is there, also of the folders shared with a batch system; in transactions
  // of its own. Then the files of all results that are durable are gone.
  void ingest_spool();

  // The next seed to be run within the bounds. Of a budget is left what was not spent and what the seeds that
  // are out are not expected to cost.
  std::optional<SeedId> next() const;
  // Books that seed as given to a worker; nothing when there is none to run now.
  std::optional<GivenSeed> give_out(int worker, std::int64_t process, std::int64_t engine);
  // Books a result that a worker has announced (`sha256`) or left behind (""), after `held_seconds` as in
  // AttemptEnd. False: it is none and has been turned down; `why` says so, and the attempt has not ended.
  bool take_result(const GivenSeed& given_seed, const std::string& sha256, std::int64_t step,
                   double held_seconds, std::string& why);
  // Mean wall time of the results of the seed's point; nothing when there are none.
  std::optional<double> wall_seconds(const GivenSeed& given_seed) const;
  // Books any other end of an attempt: the seed is queued again, or given up.
  void end_attempt(const GivenSeed& given_seed, const AttemptEnd& end);
  // Warns after the commit.
  void warn(std::string text) { changes_.after.warn(std::move(text)); }
  void renew_lease(const GivenSeed& given_seed, const JobProgress& progress);

  // The seeds that the next stop tests need and nobody runs, with `ahead` those of the looks after them, too.
  // They are out from now on; the caller hands them over.
  std::vector<SeedId> draw(bool ahead);
  // Nothing for a point that has left the sweep.
  std::optional<SeedId> identify(std::int64_t point_id, int seed) const;
  // The seed has ended, with a result or without.
  bool has_ended(SeedId id);
  // Books how an attempt at a seed that was handed over ended on a node: as end_attempt().
  void end_handed_over(SeedId id, int task, const AttemptReport& report, const fs::path& checkpoint);
  // A seed that was handed over comes back without an attempt.
  void take_back(SeedId id);

  // The engine that says this of itself runs from now on: one for the whole of a run, and never two at one
  // point. Returns its row. Throws OtherEngine if a point that is still to be run has results of another one,
  // IntegrityError if this run has begun with another one or if it does not say what it is.
  std::int64_t admit_engine(const Json& engine);
  // Keeps the results of other engines apart at every point that is still to be run, in a transaction of its
  // own. Returns how many points these were.
  int accept_engine(const std::string& identity);
  bool has_engine() const { return !engine_.empty(); }

  // The campaign is another one from now on. Throws InputError when finished realisations lack its
  // observable.
  void take_over(const Campaign& campaign);
  // Takes the picture from the database again, to which others have written within the transaction, and
  // stores the stop tests and seeds that follow. Throws OtherEngine as admit_engine(). The places of the
  // seeds that workers have are then to be found with find_place().
  void refresh();
  // Drops what was to follow a transaction that failed, and takes the picture from the database again. The
  // places of seeds are then to be found as after refresh().
  void roll_back();
  // Finds the place of the seed's point. Returns false if the seed is not wanted any more, because its point
  // was cancelled or left the sweep, or the maximum is smaller now.
  bool find_place(GivenSeed& given_seed) const;

  // Moves files that are no results and discards checkpoints, begins to remove the files of results that are
  // durable now, and tells what happened. Throws InputError when results lack the observable.
  void after_commit();

  const Campaign& campaign() const { return next_campaign_ ? *next_campaign_ : campaign_; }
  const PointRecord& point(int place) const { return point_states_.point(place); }
  const Scheduler& scheduler() const { return point_states_.scheduler(); }
  // Processor time that this run's attempts took: that of results, and of others the time times the threads.
  // A result that began in an earlier run counts with what it took in this one.
  double spent_seconds() const { return committed_.spent_seconds + changes_.spent_seconds; }
  // Points, seeds and time to go with so many workers; the rest of the report is the caller's.
  RunReport report(int workers);
  // "peclet=10 seed 3", for people
  std::string name(SeedId id) const;

 private:
  void remove_late_checkpoints();
  // Nothing for a file that is no checkpoint of a point in the sweep.
  std::optional<SeedId> seed_of_checkpoint(const fs::path& file) const;
  void read_point_states();
  void book_stop_tests();
  void refuse_other_engine(const std::string& identity) const;
  // Whether the seed has a part in the stop tests.
  bool takes_part(SeedId id) const {
    return id.point != nowhere && id.seed < campaign().maximum_realisations;
  }
  void leave(const GivenSeed& given_seed);
  std::string name_of(const GivenSeed& given_seed) const;
  PointName point_name(int place) const;
  PointName point_name(const GivenSeed& given_seed) const;
  void leave_to_batch_system(int place);
  void ingest_spool_of(const CampaignDirectory& directory);
  void ingest(const fs::path& spool);
  using Reading = std::function<RealisationResult()>;
  using Booking = std::function<void(const RealisationResult&)>;
  // Reads a result and books it, wholly or not at all. Returns why it is turned down; "" when it is not.
  std::string take_whole(const fs::path& spool, const Reading& read, const Booking& book);
  void take(const RealisationResult& result, const fs::path& spool);
  void note_lacking(const RealisationResult& result);
  void book_outcome(SeedId id, const Outcome& outcome);
  void store_stop_tests(int place, std::size_t known);
  void turn_down(const fs::path& spool, const std::string& why);

  Database& database_;
  SeedStore seeds_;
  ResultStore results_;
  PointStore rows_;
  EventStore events_;
  Campaign campaign_;
  CampaignDirectory directory_;
  RunListener& listener_;
  int retries_;
  PointStates point_states_;
  std::string engine_;  // identity of the one that runs; "" before one has
  struct Lacking {
    std::string observable;  // of the target, that results do not have
    std::string names;       // what they have instead
  };
  // What follows a commit, and what it makes true.
  struct Changes {
    AfterCommit after;
    double spent_seconds = 0;
    std::optional<Lacking> lacking;
    bool have_changed_points = false;  // a result has changed the board
    void add(Changes&& later);
  };
  Changes changes_;                        // of the open transaction
  std::optional<Campaign> next_campaign_;  // of the open transaction
  Changes committed_;                      // what is left to do of earlier ones
  FileRemoval removal_;
  int turned_down_ = 0;         // of the spool files that are looked at together
  std::set<std::string> away_;  // shared folders that are not there, as has been said
};

}  // namespace peclet::runner
