#include "runner/launch/launching.h"

#include <gtest/gtest.h>

#include "contract/durable_file.h"
#include "contract/errors.h"
#include "tests/runner/runner_fixture.h"

namespace peclet::runner {
namespace {

class Hosts : public testing::Test {
 protected:
  std::vector<Host> read(const std::string& text) {
    write_durably(file_, text);
    return read_hosts(file_);
  }
  std::string why_refused(const std::string& text) {
    try {
      read(text);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
  TemporaryFolder folder_;
  fs::path file_ = folder_.path() / "hosts.txt";
};

TEST_F(Hosts, AreReadAsMpiWritesThem) {
  const std::vector<Host> hosts =
      read("# ours\nnode1\n\n  node2 slots=8 max_slots=16  # large\nme@node3.site:4\r\nnode1 slots=2\n");
  ASSERT_EQ(hosts.size(), 3U);
  EXPECT_EQ(hosts[0].name, "node1");
  EXPECT_EQ(hosts[0].slots, 3);  // a host may be there twice
  EXPECT_EQ(hosts[1].name, "node2");
  EXPECT_EQ(hosts[1].slots, 8);
  EXPECT_EQ(hosts[2].name, "me@node3.site");
  EXPECT_EQ(hosts[2].slots, 4);
}

TEST_F(Hosts, AreRefusedWithTheirLine) {
  for (const char* line :
       {"-oProxyCommand=x", "node 1", "node:0", "node slots=", "node:100001", "a;b", "$(x)", "node:1:2"}) {
    const std::string why = why_refused(std::string("good\n") + line + "\n");
    EXPECT_NE(why.find("line 2"), std::string::npos) << line << ": " << why;
  }
  EXPECT_NE(why_refused("# nothing\n").find("must have a line with a host"), std::string::npos);
}

EngineCommand engine() {
  EngineCommand command;
  command.program = "/opt/engine";
  command.arguments = {"serve"};
  return command;
}

TEST(LaunchedWorkers, GetTheCommandOfTheLauncher) {
  const Launching launching = read_launching("srun --exact -n1 -c{threads}", "", 2);
  const LaunchedWorkers workers = launched_workers(engine(), launching, 2, 4, 60);
  ASSERT_EQ(workers.commands.size(), 2U);
  const std::vector<std::string> expected{"worker", "--through", "srun --exact -n1 -c4", "--silence",
                                          "60",     "--",        "/opt/engine",          "serve"};
  EXPECT_EQ(workers.commands[1].arguments, expected);
  EXPECT_EQ(workers.hosts, (std::vector<std::string>{"--launch", "--launch"}));
}

TEST_F(Hosts, GetWorkersInTurn) {
  write_durably(file_, "a\nb:3\nc:2\n");
  EXPECT_EQ(read_launching("", file_, 0).workers, 6);
  EXPECT_EQ(read_launching("", file_, 100).workers, 6);
  const Launching launching = read_launching("", file_, 5);
  const LaunchedWorkers workers = launched_workers(engine(), launching, launching.workers, 1, 60);
  EXPECT_EQ(workers.hosts, (std::vector<std::string>{"a", "b", "c", "b", "c"}));
  EXPECT_TRUE(workers.commands[1].arguments[2].starts_with("ssh "));
  EXPECT_TRUE(workers.commands[1].arguments[2].ends_with(" b"));
  EXPECT_EQ(workers.commands[3].environment, std::vector<std::string>{"PECLET_DEVICE_NUMBER=1"});
}

TEST_F(Hosts, FitTheLauncher) {
  write_durably(file_, "a\n");
  const auto why_refused = [](const std::string& launcher, const fs::path& hosts, int workers) {
    try {
      read_launching(launcher, hosts, workers);
    } catch (const InputError& error) {
      return error.pointer();
    }
    return std::string();
  };
  EXPECT_EQ(why_refused("mpiexec -host {host}", file_, 0), "");
  EXPECT_EQ(why_refused("srun", "", 3), "");
  EXPECT_EQ(why_refused("srun", "", 0), "--workers");
  EXPECT_EQ(why_refused("srun", file_, 0), "--launch");
  EXPECT_EQ(why_refused("mpiexec -host {host}", "", 3), "--hosts");
  EXPECT_THROW(read_launching("", folder_.path() / "absent", 0), InputError);
}

}  // namespace
}  // namespace peclet::runner
