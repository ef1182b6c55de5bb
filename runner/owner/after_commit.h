// AfterCommit holds what may happen only once a transaction is committed: files are removed, and people and
// programs are told. If the process is killed in between, the next run finds these files and handles them.
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
  // Renames a file that a result left to its place, whose folder exists, before anything is removed.
  void keep(fs::path from, fs::path place) { to_keep_.emplace_back(std::move(from), std::move(place)); }
  // Removes a checkpoint that the next attempt must not find, before carry_out() returns.
  void discard(fs::path checkpoint) { to_discard_.push_back(std::move(checkpoint)); }
  // Removes what is left of an ended seed, in the background.
  void remove(fs::path file) { to_remove_.push_back(std::move(file)); }
  // Moves a spool file that is not a result to the rejected files of its folder.
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

  // Appends what is to be done after all of this.
  void add(AfterCommit&& later);

  // Does everything once. Requires that the transaction is committed. Throws fs::filesystem_error, or
  // std::system_error for a file that could not be moved or an earlier one that could not be removed; all is
  // then left to the next call.
  void carry_out(RunListener& listener, FileRemoval& removal);

 private:
  using Telling = std::function<void(RunListener&)>;
  void tell_later(Telling telling) { to_tell_.push_back(std::move(telling)); }

  std::vector<std::pair<fs::path, fs::path>> to_keep_;
  std::vector<fs::path> to_discard_, to_remove_, to_reject_;
  std::vector<Telling> to_tell_;
};

// Takes the files that a realisation left beside its result, inside the transaction of the result, which is
// stored now or was known before. `keep` says whether files of a new result are kept. Throws ResultError if a
// file of a new result is absent or differs, std::system_error if the machine fails.
//
// The rows of the files are stored with the result. The files get their places after that commit, before the
// spool file is removed. Each file stays open from its check on, so what was checked is what is kept. If the
// process is killed, the next run finds the spool file, whose result is known by then, and continues.
void take_files(Connection& connection, const CampaignDirectory& directory, const RealisationResult& result,
                const fs::path& spool, const StoredResult& stored, bool keep, AfterCommit& after);

// Removes files in the spool whose attempts gave no result and whose processes have ended.
void remove_files_of_the_dead(Database& database, const CampaignDirectory& directory);

}  // namespace peclet::runner
