// The engine's handling of many jobs at once, which share an ensemble.
#include <sched.h>
#include <sys/mount.h>

#include <fstream>
#include <set>

#include "tests/engine/realisation/processor_ensemble.h"
#include "tests/engine/realisation/serving.h"

namespace peclet::engine {
namespace {

constexpr std::size_t places = 3;

struct HasEnsemble {
  ProcessorEnsemble ensemble_{places};
};

template <Device device>
class ServingManyWith : HasEnsemble, public Serving {
 protected:
  ServingManyWith() : Serving(&ensemble_, device) {}

  // Waits until each of the jobs has made steps.
  void wait_for_steps(std::set<int> jobs) {
    for (Json message; !jobs.empty();) {
      ASSERT_EQ(runner_.receive(message, std::chrono::minutes(1)), FrameChannel::Status::message);
      ASSERT_EQ(message.at("type"), "progress");
      EXPECT_EQ(message.at("phase") == "packing", message.at("steps") == 0);
      if (message.at("phase") != "packing" && message.at("step") > 0)
        jobs.erase(message.at("job").get<int>());
    }
  }
  // Expects an answer of this type for each of the jobs, in any order.
  void expect_answers(const char* type, std::set<int> jobs) {
    while (!jobs.empty()) {
      const Json message = answer();
      ASSERT_TRUE(message.is_object());
      ASSERT_EQ(message.at("type"), type) << message;
      EXPECT_EQ(jobs.erase(message.at("job").get<int>()), 1U);
    }
  }
  void give_all(const std::set<int>& jobs, const Json& scene) {
    for (const int job : jobs) give(job, scene);
  }
  Json validated(const Json& scene) {
    runner_.send({{"type", "validate"}, {"request", 1}, {"scene", scene}});
    return answer();
  }
};
using ServingMany = ServingManyWith<Device::cuda>;
using ServingManyOrTheProcessor = ServingManyWith<Device::automatic>;

TEST_F(ServingMany, GivesTheResultOfEachJobAlone) {
  EXPECT_EQ(hello_.at("capacity"), places + 1);
  EXPECT_EQ(hello_.at("ahead"), false);
  const std::set<int> all{1, 2, 3, 4};
  give_all(all, brief);
  expect_answers("result", all);
  for (const int job : all) {
    Json result = Json::parse(read_file(spool(job)));
    EXPECT_EQ(result.at("engine").at("device"), "stand-in 1");
    EXPECT_EQ(result.at("engine").at("instruction_set"), hello_.at("engine").at("instruction_set"));
    JobSpecification same = job_of(brief, "", 100U + static_cast<std::uint64_t>(job));
    same.header.point = std::string(64, 'a');
    Json alone = run_job(same, {}).value();
    for (Json* const one : {&result, &alone}) one->erase("engine");
    EXPECT_EQ(without_cost(result).dump(), without_cost(alone).dump());
  }
  give_all({5, 6}, brief);
  expect_answers("result", {5, 6});
}

// The fourth job is ready and waits for a place.
TEST_F(ServingMany, ADrainIsAnsweredForEachJob) {
  give_all({1, 2, 3}, endless);
  wait_for_steps({1, 2, 3});
  give(4, endless);
  drain();
  expect_answers("drained", {1, 2, 3, 4});
  EXPECT_TRUE(answer().is_null());
  leave();
  EXPECT_EQ(status_, 0);
  for (const int job : {1, 2, 3}) EXPECT_TRUE(std::filesystem::exists(checkpoint(job)));
}

TEST_F(ServingMany, ADrainFindsItIdle) {
  drain();
  EXPECT_TRUE(answer().is_null());
  leave();
  EXPECT_EQ(status_, 0);
}

TEST_F(ServingMany, ARunnerThatIsGoneLeavesCheckpoints) {
  give_all({1, 2, 3}, endless);
  wait_for_steps({1, 2, 3});
  leave();
  EXPECT_EQ(status_, 0);
  for (const int job : {1, 2, 3}) EXPECT_TRUE(std::filesystem::exists(checkpoint(job)));
}

TEST_F(ServingMany, TakesOneJobMoreThanItHasPlaces) {
  give_all({1, 2, 3, 4, 5}, endless);
  expect_answers("failed", {5});
  drain();
  expect_answers("drained", {1, 2, 3, 4});
}

TEST_F(ServingMany, RefusesScenesThatTheEnsembleCannotRun) {
  const Json other = small_scene(implicit_and_light);
  give(1, endless);
  const Json refused = validated(other);
  EXPECT_EQ(refused.at("type"), "refused");
  EXPECT_EQ(refused.at("pointer"), "/integrator/method");
  EXPECT_EQ(refused.at("value"), "implicit");
  EXPECT_EQ(refused.at("allowed"), "must be explicit");
  EXPECT_EQ(validated(brief).at("type"), "validated");
  give(2, other);
  expect_answers("failed", {2});
}

TEST_F(ServingManyOrTheProcessor, RunsEveryScene) {
  const Json other = small_scene(implicit_and_light);
  EXPECT_EQ(validated(other).at("type"), "validated");
  give(1, other);
  give(2, brief);
  expect_answers("result", {1, 2});
  EXPECT_EQ(Json::parse(read_file(spool(1))).at("engine").at("device"), "processor");
  EXPECT_EQ(Json::parse(read_file(spool(2))).at("engine").at("device"), "stand-in 1");
}

// Mounts a small file system in the folder, as root or in a user namespace. Returns false if the kernel
// grants neither.
bool has_small_disk(const std::filesystem::path& folder) {
  std::filesystem::create_directory(folder);
  const auto user = ::getuid(), group = ::getgid();
  if (::unshare(CLONE_NEWNS) != 0) {
    if (::unshare(CLONE_NEWUSER | CLONE_NEWNS) != 0) return false;
    std::ofstream("/proc/self/setgroups") << "deny";
    std::ofstream("/proc/self/uid_map") << "0 " << user << " 1";
    std::ofstream("/proc/self/gid_map") << "0 " << group << " 1";
  }
  return ::mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) == 0 &&
         ::mount("none", folder.c_str(), "tmpfs", 0, "size=32k") == 0;
}

// The small file system is seen by this thread and those that it starts.
TEST(ServingManyOnAFullDisk, KeepsItsResultsWhileOthersGoOn) {
  const TemporaryFolder folder;
  const std::filesystem::path disk = folder / "disk";
  ASSERT_TRUE(has_small_disk(disk)) << "needs root, or unprivileged user namespaces";
  class OnADisk : public ServingMany {
   public:
    void TestBody() override {}
    void run(const std::filesystem::path& full) {
      write_durably(full / "ballast", std::string(24576, 'x'));
      for (const int job : {1, 2}) {
        Json message = message_of(job, brief);
        message["spool"] = full / std::to_string(job);
        runner_.send(message);
      }
      std::set<int> waiting;
      while (waiting.size() < 2) {
        const Json message = answer();
        ASSERT_EQ(message.at("type"), "no-room") << message;
        waiting.insert(message.at("job").get<int>());
      }
      give(3, brief);
      Json message;
      while ((message = answer()).at("type") == "no-room") {
      }
      EXPECT_EQ(message.at("type"), "result");
      EXPECT_EQ(message.at("job"), 3);
      std::filesystem::remove(full / "ballast");
      std::set<int> ended;
      while (ended.size() < 2) {
        if ((message = answer()).at("type") == "no-room") {
          if (!ended.empty()) std::filesystem::remove(full / std::to_string(*ended.begin()));
          continue;
        }
        ASSERT_EQ(message.at("type"), "result") << message;
        ended.insert(message.at("job").get<int>());
      }
    }
  };
  OnADisk().run(disk);
  ::umount2(disk.c_str(), MNT_DETACH);
}

TEST(ServingManyDeathTest, AStopEndsAtOnce) {
  testing::GTEST_FLAG(death_test_style) = "threadsafe";
  const auto stopped = [] {
    std::array<int, 2> ends{};
    if (::socketpair(AF_UNIX, SOCK_STREAM, 0, ends.data()) != 0) return;
    FrameChannel runner(ends[0]);
    for (const int job : {1, 2}) {
      runner.send({{"type", "job"},
                   {"job", job},
                   {"point", std::string(64, 'a')},
                   {"seed", job},
                   {"scene", endless},
                   {"checkpoint", ""},
                   {"spool", ""}});
    }
    runner.send({{"type", "stop"}});
    ProcessorEnsemble ensemble(places);
    serve(ends[1], &ensemble, Device::cuda);
    std::exit(1);
  };
  EXPECT_EXIT(stopped(), testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace peclet::engine
