// BatchFixture has a campaign with the fake engine, and a batch system of four scripts.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "contract/json.h"
#include "runner/command_line/hand_over.h"
#include "runner/store/database.h"
#include "tests/runner/runner_fixture.h"

namespace peclet::runner {

// Waits up to a minute until the condition holds. Returns false if it does not.
bool comes_true(const std::function<bool()>& is_so);

class BatchFixture : public testing::Test {
 protected:
  static constexpr int tasks = 5;  // ten seeds, two a task

  BatchFixture();
  ~BatchFixture() override;

  // Sets a variable of the fake engine until the end of the test.
  void set(const std::string& variable, const std::string& value);

  // Sets what the scripts do with submissions: take all ("ok"), only the first ("one") or none ("refused");
  // fail on the way after or before one is taken ("lost", "unheard"), or with all work done ("late"). Queries
  // are answered or not.
  void submissions(const std::string& kind) const;
  void queries(bool answered) const;
  // Sets what a query says of the tasks of every job that was taken: lines of INDEX STATE.
  void states(const std::string& lines) const;
  int submitted() const;

  int hand_over() const { return hand_over_campaign(options); }
  int forget(int number) const {
    return ingest_campaign({options.campaign, {}, false, true, false, {name(number)}});
  }
  int cancel() const { return ingest_campaign({options.campaign, {}, true, true, false}); }
  int ingest() const { return ingest_campaign({options.campaign, {}, false, true, false}); }
  // Runs a task of the bundle of this number (from 1) here, as a node would.
  int run_task(int bundle, int index) const;
  int run_locally() const;

  std::string name(int bundle) const;
  std::filesystem::path bundle(int number) const;
  std::filesystem::path shared() const { return options.shared; }
  std::filesystem::path folder() const { return folder_.path(); }
  std::int64_t count(const std::string& sql) const;
  std::int64_t seeds_out() const { return count("SELECT count(*) FROM bundle_seed WHERE outcome IS NULL"); }
  std::string text(const std::string& sql) const;
  // Return the canonical exports of the campaign and of the same campaign run without a batch system.
  std::string answer() const;
  std::string local_answer() const;

  HandOverOptions options;  // two points, five seeds each, two seeds a task, four checkpoints on the way

 private:
  TemporaryFolder folder_;
  std::vector<std::string> variables_;
};

}  // namespace peclet::runner
