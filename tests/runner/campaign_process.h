// CampaignOnDisk runs a campaign with the fake engine in processes of their own, to be signalled and killed.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>

#include "contract/json.h"
#include "runner/command_line/run.h"
#include "runner/store/database.h"
#include "tests/runner/runner_fixture.h"

namespace peclet::runner {

using Environment = std::map<std::string, std::string>;

// A campaign file in a temporary folder, and runs of it.
class CampaignOnDisk {
 public:
  explicit CampaignOnDisk(int points = 2);

  Json document;  // written at each start
  RunOptions options;
  std::optional<int> pilot;  // seeds of `peclet plan --pilot`, which is then run instead

  // Starts a run in a child process; finish() waits for it.
  void start(const Environment& environment = {});
  // Returns the exit code of the run; -N if signal N killed it.
  int finish();
  int run(const Environment& environment = {});
  // Returns an environment in which no seed from `seed` on ends before release(): the run is not over before
  // the test says so, however slow the machine is. Earlier seeds give their results.
  Environment held_from(int seed, Environment environment = {}) const;
  void release() const;
  void signal(int number) const;
  void kill_workers() const;
  // Waits until this number of realisations is done. Throws if that takes a minute.
  void wait_for_results(int count) const;
  // Waits until the condition holds. Throws if that takes a minute.
  void wait_until(const std::string& what, const std::function<bool()>& is_so) const;

  const CampaignDirectory& directory() const { return directory_; }
  Database reader() const { return Database::open_reader(directory_.database()); }
  std::int64_t count(const std::string& sql) const;
  // Returns all stop tests and the contents of the seeds that decided, which must not depend on disturbances.
  std::string answer() const;
  std::string log() const;

 private:
  std::filesystem::path hold() const { return folder_.path() / "hold"; }

  TemporaryFolder folder_;
  CampaignDirectory directory_;
  pid_t process_ = -1;
};

}  // namespace peclet::runner
