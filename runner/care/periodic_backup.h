// Backups of a campaign while it runs, in a thread of their own: the dispatcher never waits for one.
#pragma once

#include <chrono>
#include <future>
#include <string>

#include "runner/care/backup.h"
#include "runner/events/run_listener.h"

namespace peclet::runner {

// All functions are for the owner's thread. A backup that fails is a warning; the next one is tried all the
// same, and the generations that were there stay.
class PeriodicBackup {
 public:
  using Time = std::chrono::steady_clock::time_point;

  // `listener` must outlive it.
  PeriodicBackup(CampaignDirectory directory, std::chrono::duration<double> interval, RunListener& listener,
                 Time now);
  // Waits for a backup that is being made.
  ~PeriodicBackup();
  PeriodicBackup(const PeriodicBackup&) = delete;
  PeriodicBackup& operator=(const PeriodicBackup&) = delete;

  // Starts a backup when one is due, and tells what became of the last one.
  void attend(Time now);
  // The backup at the end of a run: waits for one that is being made, then makes another.
  void finish();

 private:
  void start();
  void tell();

  CampaignDirectory directory_;
  std::chrono::duration<double> interval_;
  RunListener& listener_;
  Time last_;
  std::future<Backup> running_;
  std::string complaint_;  // the last one: the same is not made twice
};

}  // namespace peclet::runner
