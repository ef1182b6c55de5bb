// CampaignState keeps the scheduler, the database and the spool of a running campaign in step.
//
// The writing functions run inside a Transaction of the caller. Effects that must follow its commit are kept
// until after_commit(). Whenever a process is killed, database and spool together hold every result once.
//
// After a failure these effects are dropped and the state is read again from the rolled-back database.
// roll_back() does this for a transaction, take_whole() for a single result within one.
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
#include "runner/owner/suspects.h"
#include "runner/store/campaign_directory.h"
#include "runner/store/point_store.h"
#include "runner/store/result_store.h"
#include "runner/store/seed_store.h"

namespace peclet::runner {

// Thrown if points with results of one engine are to be run with another; what() names both.
class OtherEngine : public IntegrityError {
 public:
  using IntegrityError::IntegrityError;
};

// A seed that a worker has.
struct GivenSeed {
  SeedId id;  // its point is `nowhere` if the point has left the sweep
  std::int64_t point_id = 0;
  Job job;
};

class CampaignState {
 public:
  // Requires the campaign that the database has adopted. Takes in what earlier runs left in the spool, then
  // queues the seeds of a dead owner again. All references must outlive the state.
  CampaignState(Database& database, Campaign campaign, CampaignDirectory directory, RunListener& listener,
                int retries);

  // Sets the bounds from now on. With a budget, seeds go where they lower the summed relative error most;
  // without one, to the point that will take longest.
  void set_bounds(Bounds bounds);

  // Takes in every spool file, also from folders shared with a batch system, in transactions of its own.
  // Returns once the files of these results are removed.
  void ingest_spool();

  // Returns the next seed to be run within the bounds. The remaining budget is what was not spent, less the
  // expected cost of the seeds that workers have.
  std::optional<SeedId> next() const;
  // Books the next seed as given to a worker whose engine has this company; suspects go first. Returns
  // nothing if no seed is to be run there now.
  std::optional<GivenSeed> give_out(int worker, std::int64_t process, std::int64_t engine,
                                    const Company& company = {});
  // True if some seed may not join every company.
  bool has_suspects() const { return suspects_.any(); }
  // Returns the halvings() of a seed of a point.
  int halvings_of(std::int64_t point_id, int seed) { return halvings(seeds_.history(point_id, seed)); }
  // Books a result that a worker announced (`sha256`) or left behind (""); `held_seconds` is as in
  // AttemptEnd. Returns false if the file is not a valid result of the job: it is rejected, `why` says why,
  // and the attempt has not ended.
  bool take_result(const GivenSeed& given_seed, const std::string& sha256, std::int64_t step,
                   double held_seconds, std::string& why);
  // Returns the mean wall time [s] of the results of the seed's point, if there are any.
  std::optional<double> wall_seconds(const GivenSeed& given_seed) const;
  // Books any other end of an attempt: the seed is queued again, or given up.
  void end_attempt(const GivenSeed& given_seed, const AttemptEnd& end);
  // Warns once the transaction is committed.
  void warn(std::string text) { changes_.after.warn(std::move(text)); }
  void renew_lease(const GivenSeed& given_seed, const JobProgress& progress);

  // Returns the seeds of the next stop tests that have not begun, with `ahead` also those of the stop tests
  // after them. Marks them as begun; the caller hands them over.
  std::vector<SeedId> draw(bool ahead);
  // Returns nothing if the point has left the sweep.
  std::optional<SeedId> identify(std::int64_t point_id, int seed) const;
  // True if the seed has ended, with a result or without.
  bool has_ended(SeedId id);
  // Books how an attempt at a handed-over seed ended on a node, as end_attempt() does.
  void end_handed_over(SeedId id, int task, const AttemptReport& report, const fs::path& checkpoint);
  // Gives a handed-over seed back to the scheduler without an attempt.
  void take_back(SeedId id);

  // Admits the engine with this provenance and returns its row. A run uses one engine, and a point never
  // mixes two. Throws OtherEngine if a point that is still to be run has results of another engine, and
  // IntegrityError if this run began with another engine or the provenance is incomplete.
  std::int64_t admit_engine(const Json& engine);
  // Sets aside the results of other engines at every point that is still to be run, in a transaction of its
  // own. Returns the number of these points.
  int accept_engine(const std::string& identity);
  bool has_engine() const { return !engine_.empty(); }

  // Takes over a changed campaign within the transaction. Throws InputError if results lack its observable.
  void take_over(const Campaign& campaign);
  // Reads the state again after others have written to the database within the transaction, and stores the
  // stop tests, the chosen values and the seeds that follow. Throws OtherEngine as admit_engine(). The seeds
  // that workers have then need find_place().
  void refresh();
  // Adds the values of the axis that decided curves ask for, if the campaign chooses values. To be called
  // within a transaction that has booked results. Returns true if it did: the seeds that workers have then
  // need find_place().
  bool choose_values();
  // Drops the effects of a failed transaction and reads the state from the database again. The seeds that
  // workers have then need find_place().
  void roll_back();
  // Finds the place of the seed's point. Returns false if the seed is no longer wanted: its point was
  // cancelled or left the sweep, or the maximum is smaller now.
  bool find_place(GivenSeed& given_seed) const;

  // Carries out what follows the commit: moves rejected files, discards checkpoints, begins to remove the
  // files of durable results, and tells what happened. Throws InputError if results lack the observable.
  void after_commit();

  const Campaign& campaign() const { return next_campaign_ ? *next_campaign_ : campaign_; }
  const PointRecord& point(int place) const { return point_states_.point(place); }
  const Scheduler& scheduler() const { return point_states_.scheduler(); }
  // Processor time [s] of this run's attempts. A result counts with its own processor time, but no more than
  // its worker held the seed in this run; any other attempt counts with its wall time times the threads.
  double spent_seconds() const { return committed_.spent_seconds + changes_.spent_seconds; }
  // Returns points, seeds, spent time and time to go for this number of workers; the rest is the caller's.
  RunReport report(int workers);
  // Returns the seed's name for people: "peclet=10 seed 3".
  std::string name(SeedId id) const;

 private:
  void remove_late_checkpoints();
  // Returns nothing if the file is not a checkpoint of a point in the sweep.
  std::optional<SeedId> seed_of_checkpoint(const fs::path& file) const;
  void read_point_states();
  void read_again();
  void book_stop_tests();
  void refuse_other_engine(const std::string& identity) const;
  bool takes_part(SeedId id) const {
    return id.point != nowhere && id.seed < campaign().maximum_realisations;
  }
  void leave(const GivenSeed& given_seed);
  std::optional<SeedId> next_for(const Company& company);
  std::optional<double> budget_left() const;
  std::string name_of(const GivenSeed& given_seed) const;
  PointName point_name(int place) const;
  PointName point_name(const GivenSeed& given_seed) const;
  void leave_to_batch_system(int place);
  void ingest_spool_of(const CampaignDirectory& directory);
  void ingest(const fs::path& spool);
  using Reading = std::function<RealisationResult()>;
  using Booking = std::function<void(const RealisationResult&)>;
  // Reads a result and books it, wholly or not at all. Returns why it is rejected; "" if it is not.
  std::string take_whole(const fs::path& spool, const Reading& read, const Booking& book);
  void take(const RealisationResult& result, const fs::path& spool);
  void note_lacking(const RealisationResult& result);
  void book_outcome(SeedId id, const Outcome& outcome);
  void store_stop_tests(const Change& change);
  void book_change(const Change& change);
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
  std::string engine_;  // identity of the running engine; "" before one is admitted
  struct Lacking {
    std::string observable;  // observable of the target, missing from the results
    std::string names;       // numbers that the results have instead
  };
  // Effects that follow a commit.
  struct Changes {
    AfterCommit after;
    double spent_seconds = 0;
    std::optional<Lacking> lacking;
    bool have_changed_points = false;  // a result has changed point_states_
    void add(Changes&& later);
  };
  Changes changes_;                        // effects of the open transaction
  std::optional<Campaign> next_campaign_;  // campaign after the open transaction
  Changes committed_;                      // effects of earlier transactions, not carried out yet
  FileRemoval removal_;
  Suspects suspects_;           // read once an engine has room for two seeds
  int turned_down_ = 0;         // spool files rejected in the present batch
  std::set<std::string> away_;  // shared folders already reported as missing
};

}  // namespace peclet::runner
