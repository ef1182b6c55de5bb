// What may happen only when a transaction is committed: files go, and people and programs hear of it.
//
// A process that is killed in between leaves the files, which the next run finds and takes for what they are.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "runner/campaign/paths.h"
#include "runner/owner/run_listener.h"
#include "runner/store/campaign_directory.h"
#include "runner/store/file_removal.h"
#include "runner/store/realisation_result.h"
#include "runner/store/result_store.h"
#include "runner/store/sqlite.h"

namespace peclet::runner {

class AfterCommit {
 public:
  // A file that a result left gets its place, whose folder is there; before anything is removed.
  void keep(fs::path from, fs::path place) { to_keep_.emplace_back(std::move(from), std::move(place)); }
  // A checkpoint that the next attempt must not find: gone when carry_out() returns.
  void discard(fs::path checkpoint) { to_discard_.push_back(std::move(checkpoint)); }
  // What is left of a seed that has ended: removed in the background.
  void remove(fs::path file) { to_remove_.push_back(std::move(file)); }
  // A spool file that is no result: moved to the rejected ones of its folder.
  void reject(fs::path spool) { to_reject_.push_back(std::move(spool)); }
  void note(std::string text) {
    tell_later([text = std::move(text)](RunListener& listener) { listener.note(text); });
  }
  void warn(std::string text) {
    tell_later([text = std::move(text)](RunListener& listener) { listener.warn(text); });
  }
  void tell(RunEvent event) {
    tell_later([event = std::move(event)](RunListener& listener) { listener.happened(event); });
  }

  // Appends what is to be done later than all of this.
  void add(AfterCommit&& later);

  // Does all of it, once. Requires that the transaction is committed. Throws
  // fs::filesystem_error, and std::system_error for a file that could not be moved, or one of an
  // earlier call that could not be removed; all is then left to the next call.
  void carry_out(RunListener& listener, FileRemoval& removal);

 private:
  using Telling = std::function<void(RunListener&)>;
  void tell_later(Telling telling) { to_tell_.push_back(std::move(telling)); }

  std::vector<std::pair<fs::path, fs::path>> to_keep_;
  std::vector<fs::path> to_discard_, to_remove_, to_reject_;
  std::vector<Telling> to_tell_;
};

// Files that a realisation left beside its result. Their rows are stored with the result, and they get their
// places after that commit, before the spool file of the result goes. What was checked is what gets there: it
// is held open meanwhile. So whatever is killed when, the spool file is found again, as a result that is
// known by then, and the moving goes on from there.
//
// Takes the files of a result that has been stored, or that is known, inside its transaction. With `keep`
// files of a new one are kept. Throws ResultError if a file of a new one is absent or another one;
// std::system_error if the machine fails.
void take_files(Connection& connection, const CampaignDirectory& directory, const RealisationResult& result,
                const fs::path& spool, const StoredResult& stored, bool keep, AfterCommit& after);

// Removes files in the spool of attempts that gave no result and whose processes no longer run.
void remove_files_of_the_dead(Database& database, const CampaignDirectory& directory);

}  // namespace peclet::runner
