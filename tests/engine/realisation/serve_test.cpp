// The engine's handling of jobs that arrive while one runs.
#include "tests/engine/realisation/serving.h"

namespace peclet::engine {
namespace {

TEST_F(Serving, BeginsTheJobThatWaitsWhenTheOtherHasEnded) {
  EXPECT_EQ(hello_.at("ahead"), true);
  give(1, brief);
  wait_for_progress();
  give(2, brief);
  for (const int job : {1, 2}) {
    expect_answer("result", job);
    EXPECT_EQ(Json::parse(read_file(spool(job))).at("seed"), 100 + job);
  }
}

TEST_F(Serving, ADrainGivesUpTheJobThatWaitsWithoutAWord) {
  give(1, endless);
  wait_for_progress();
  give(2, endless);
  drain();
  expect_answer("drained", 1);
  drain();
  EXPECT_TRUE(answer().is_null());
  expect_to_leave_one_checkpoint();
}

TEST_F(Serving, ARunnerThatIsGoneWantsNoJobThatWaits) {
  give(1, endless);
  wait_for_progress();
  give(2, endless);
  expect_to_leave_one_checkpoint();
}

TEST_F(Serving, AThirdJobIsOneTooMany) {
  give(1, endless);
  wait_for_progress();
  give(2, endless);
  give(3, endless);
  const Json message = answer();
  EXPECT_EQ(message.at("type"), "failed");
  EXPECT_EQ(message.at("job"), 1);
  EXPECT_TRUE(contains(message.at("message"), "another one waits"));
  wait_for_progress();  // of the second job
  drain();
  expect_answer("drained", 2);
}

}  // namespace
}  // namespace peclet::engine
