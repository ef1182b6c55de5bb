#include "tests/runner/campaign_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <fstream>
#include <stdexcept>
#include <thread>

#include "contract/durable_file.h"
#include "runner/command_line/print.h"
#include "runner/command_line/run.h"

namespace peclet::runner {
namespace {

// Runs the verb as main.cpp does.
int run_as_program(const RunOptions& options, std::optional<int> pilot) {
  try {
    return pilot ? plan_campaign({options, pilot}) : run_campaign(options);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return exit_code_of(error);
  }
}

}  // namespace

CampaignOnDisk::CampaignOnDisk(int points) : directory_(folder_.path() / "test.peclet") {
  document = {
      {"name", "test"},
      {"scene", {{"fluid", {{"viscosity", 1}}}, {"peclet", 1}}},
      {"sweep", {{{"set", "/peclet"}, {"values", Json::array()}}}},
      {"target", {{"observable", "relative_viscosity"}, {"relative_tolerance", 0.05}, {"confidence", 0.95}}},
      {"realisations", {{"minimum", 8}, {"maximum", 60}}},
      {"engine", {FAKE_ENGINE, "serve"}}};
  for (int point = 1; point <= points; ++point) document["sweep"][0]["values"].push_back(point);
  options.campaign = folder_.path() / "test.json";
  options.workers = 2;
  options.threads = 1;
}

void CampaignOnDisk::start(const Environment& environment) {
  std::ofstream(options.campaign) << document.dump(2);
  std::fflush(nullptr);
  process_ = fork();
  if (process_ < 0) throw std::runtime_error("fork");
  if (process_ > 0) return;
  const int log = open((folder_.path() / "run.log").c_str(), O_WRONLY | O_CREAT | O_APPEND, 0644);
  dup2(log, STDOUT_FILENO);
  dup2(log, STDERR_FILENO);
  for (const auto& [name, value] : environment) setenv(name.c_str(), value.c_str(), 1);
  const int code = run_as_program(options, pilot);
  std::fflush(nullptr);
  _exit(code);
}

int CampaignOnDisk::finish() {
  int status = 0;
  waitpid(process_, &status, 0);
  process_ = -1;
  return WIFSIGNALED(status) ? -WTERMSIG(status) : WEXITSTATUS(status);
}

int CampaignOnDisk::run(const Environment& environment) {
  start(environment);
  return finish();
}

void CampaignOnDisk::signal(int number) const { kill(process_, number); }

void CampaignOnDisk::kill_workers() const {
  const std::string own = std::to_string(process_);
  std::ifstream children(fmt::format("/proc/{}/task/{}/children", own, own));
  for (pid_t child = 0; children >> child;) kill(child, SIGKILL);
}

Environment CampaignOnDisk::held_from(int seed, Environment environment) const {
  std::ofstream(hold()) << "";
  environment["PECLET_FAKE_HOLD"] = hold().string();
  environment["PECLET_FAKE_HOLD_SEED"] = std::to_string(seed);
  return environment;
}

void CampaignOnDisk::release() const { std::filesystem::remove(hold()); }

void CampaignOnDisk::wait_for_results(int count) const {
  wait_until(fmt::format("{} results", count),
             [&] { return this->count("SELECT count(*) FROM realisation WHERE state = 'done'") >= count; });
}

void CampaignOnDisk::wait_until(const std::string& what, const std::function<bool()>& is_so) const {
  const auto patience = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  while (std::chrono::steady_clock::now() < patience) {
    try {
      if (is_so()) return;
    } catch (const std::exception&) {  // there is no database yet
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  throw std::runtime_error(fmt::format("waited a minute for {}:\n{}", what, log()));
}

std::int64_t CampaignOnDisk::count(const std::string& sql) const {
  Database database = reader();
  return database.connection().integer(sql);
}

std::string CampaignOnDisk::answer() const {
  std::string answer;
  Database database = reader();
  for (const PointRecord& point : database.points()) {
    const std::vector<StopTestRecord> stop_tests = database.stop_tests(point.id);
    for (const StopTestRecord& record : stop_tests) {
      answer += fmt::format("{} stop test {} {} {} {}\n", point.label, record.stop_test.seeds,
                            record.stop_test.estimate.mean, record.stop_test.half_width,
                            to_string(record.stop_test.verdict));
    }
    for (const RealisationRecord& record : database.realisations(point.id)) {
      if (stop_tests.empty() || record.seed >= stop_tests.back().stop_test.seeds) continue;
      answer +=
          fmt::format("{} seed {} {} {}\n", point.label, record.seed, record.cause, record.content_sha256);
    }
  }
  return answer;
}

std::string CampaignOnDisk::log() const { return read_file(folder_.path() / "run.log"); }

}  // namespace peclet::runner
