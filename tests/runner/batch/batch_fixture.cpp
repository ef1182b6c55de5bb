#include "tests/runner/batch/batch_fixture.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <thread>

#include "contract/durable_file.h"
#include "runner/batch/batch_task.h"
#include "runner/command_line/run.h"
#include "runner/reports/export.h"

namespace peclet::runner {
namespace {

namespace fs = std::filesystem;

void write(const fs::path& path, const std::string& text) { std::ofstream(path) << text; }

Json campaign_document() {
  return {{"name", "batch"},
          {"scene", {{"fluid", {{"viscosity", 1}}}, {"peclet", 1}}},
          {"sweep", {{{"set", "/peclet"}, {"values", {1, 2}}}}},
          {"target", {{"relative_tolerance", 0.5}}},
          {"realisations", {{"minimum", 5}, {"maximum", 5}}},
          {"engine", {FAKE_ENGINE, "serve"}}};
}

std::string export_of(const fs::path& database) {
  Database reader = Database::open_reader(database);
  return export_json(reader, true);
}

}  // namespace

bool comes_true(const std::function<bool()>& is_so) {
  const auto patience = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  while (!is_so() && std::chrono::steady_clock::now() < patience) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return is_so();
}

BatchFixture::BatchFixture() {
  options.system = "test";
  options.campaign = folder() / "batch.json";
  options.shared = folder() / "shared";
  options.template_folder = folder() / "template";
  options.seeds_per_task = 2;
  options.checkpoint_seconds = 0.05;
  options.quiet = true;
  write(options.campaign, campaign_document().dump());
  fs::create_directories(options.template_folder);
  const std::string here = "cd '" + folder().string() + "'\n";
  write(options.template_folder / "job.sh", "@PECLET@ task @MANIFEST@ 0..@LAST@\n");
  write(options.template_folder / "submit.sh",
        here +
            "kind=$(cat submissions)\n"
            "[ \"$kind\" = unheard ] && exit 75\n"
            "[ \"$kind\" = refused ] && { echo no such partition >&2; exit 1; }\n"
            "[ \"$kind\" = one ] && [ -s jobs ] && exit 1\n"
            "echo \"$1\" >> jobs\n"
            "[ \"$kind\" = lost ] && exit 75\n"
            "[ \"$kind\" = late ] && exit 1\n"
            "wc -l < jobs\n");
  write(options.template_folder / "query.sh", here +
                                                  "[ -e silent ] && exit 1\n"
                                                  "job=$(grep -n \"^$1\\$\" jobs | cut -d: -f1)\n"
                                                  "[ -z \"$job\" ] || sed \"s/^/$job /\" states\n");
  write(options.template_folder / "cancel.sh", here + ": > states\n");
  write(options.template_folder / "largest.sh", "echo 100\n");
  write(folder() / "jobs", "");
  submissions("ok");
  states("");
}

BatchFixture::~BatchFixture() {
  for (const std::string& variable : variables_) unsetenv(variable.c_str());
}

void BatchFixture::set(const std::string& variable, const std::string& value) {
  setenv(variable.c_str(), value.c_str(), 1);
  variables_.push_back(variable);
}

void BatchFixture::submissions(const std::string& kind) const { write(folder() / "submissions", kind); }

void BatchFixture::queries(bool answered) const {
  if (answered) {
    fs::remove(folder() / "silent");
  } else {
    write(folder() / "silent", "");
  }
}

void BatchFixture::states(const std::string& lines) const { write(folder() / "states", lines); }

int BatchFixture::submitted() const {
  const std::string jobs = read_file(folder() / "jobs");
  return static_cast<int>(std::count(jobs.begin(), jobs.end(), '\n'));
}

std::string BatchFixture::name(int bundle) const {
  return text(fmt::format("SELECT name FROM bundle WHERE bundle_id = {}", bundle));
}

fs::path BatchFixture::bundle(int number) const { return shared() / "bundles" / name(number); }

int BatchFixture::run_task(int number, int index) const {
  return runner::run_task({bundle(number) / "manifest.json", index});
}

int BatchFixture::run_locally() const {
  RunOptions run;
  run.campaign = options.campaign;
  run.workers = 2;
  run.quiet = true;
  return run_campaign(run);
}

std::int64_t BatchFixture::count(const std::string& sql) const {
  return Database::open_reader(folder() / "batch.peclet" / "campaign.db").connection().integer(sql);
}

std::string BatchFixture::text(const std::string& sql) const {
  return Database::open_reader(folder() / "batch.peclet" / "campaign.db").connection().text(sql);
}

std::string BatchFixture::answer() const { return export_of(folder() / "batch.peclet" / "campaign.db"); }

std::string BatchFixture::local_answer() const {
  RunOptions run;
  run.campaign = options.campaign;
  run.directory = folder() / "local.peclet";
  run.workers = 2;
  run.quiet = true;
  run_campaign(run);
  return export_of(run.directory / "campaign.db");
}

}  // namespace peclet::runner
