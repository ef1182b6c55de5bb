// Bundles: from open seeds to a job that has been submitted.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>

#include "contract/durable_file.h"
#include "contract/guarded_file.h"
#include "contract/sha256.h"
#include "runner/batch/bundles.h"
#include "runner/store/spool.h"
#include "runner/text/host_name.h"

namespace peclet::runner {
namespace {

namespace fs = std::filesystem;

// Of the campaign's folder on this machine: campaigns of one name do not share a job's name.
std::string mark_of(const CampaignDirectory& directory) {
  return sha256(host_name() + ':' + directory.root().string()).substr(0, 6);
}

BatchTemplate filled_in(const BatchTemplate& scripts, const BundleFolder& folder, const std::string& name,
                        int tasks, int threads, const std::string& program) {
  const std::map<std::string, std::string> values{{"NAME", name},
                                                  {"LAST", std::to_string(tasks - 1)},
                                                  {"TASKS", std::to_string(tasks)},
                                                  {"THREADS", std::to_string(threads)},
                                                  {"PECLET", program},
                                                  {"MANIFEST", folder.manifest().string()},
                                                  {"FOLDER", folder.root().string()}};
  BatchTemplate filled = scripts;
  filled.at("job.sh") = fill_in(scripts.at("job.sh"), values, "job.sh");
  return filled;
}

}  // namespace

void check_template(const BatchTemplate& scripts, const fs::path& shared, const std::string& program) {
  filled_in(scripts, BundleFolder(shared, "name"), "name", 1, 1, program);
}

Bundles::Bundles(Database& database, Ledger& ledger, const Campaign& campaign, CampaignDirectory directory,
                 RunListener& listener)
    : database_(database),
      ledger_(ledger),
      campaign_(campaign),
      directory_(std::move(directory)),
      listener_(listener),
      book_(database.connection()),
      seeds_(database),
      events_(database.connection()) {}

std::string Bundles::hand_over(const BundleSettings& settings) {
  // What is not mounted now must not be made anew below it.
  if (!fs::is_directory(settings.shared) && book_.are_out_in(settings.shared.string())) {
    tell_once(
        settings.shared.string(),
        fmt::format("{}: is not there, and nothing is handed over until it is", settings.shared.string()));
    return "";
  }
  told_.erase(settings.shared.string());
  const std::vector<SeedId> seeds = ledger_.draw(settings.ahead);
  const std::size_t most =
      static_cast<std::size_t>(settings.seeds_per_task) * static_cast<std::size_t>(settings.largest_array);
  for (std::size_t from = 0; from < seeds.size(); from += most) {
    const std::size_t end = std::min(seeds.size(), from + most);
    const auto begin = seeds.begin() + static_cast<std::ptrdiff_t>(from);
    const std::string refusal = make(settings, {begin, seeds.begin() + static_cast<std::ptrdiff_t>(end)});
    if (refusal.empty()) continue;
    for (std::size_t left = end; left < seeds.size(); ++left) ledger_.take_back(seeds[left]);
    return refusal;
  }
  return "";
}

std::string Bundles::describe(const BundleSettings& settings) {
  const std::vector<SeedId> seeds = ledger_.draw(settings.ahead);
  const auto per_task = static_cast<std::size_t>(settings.seeds_per_task);
  const std::size_t tasks = (seeds.size() + per_task - 1) / per_task;
  const auto largest = static_cast<std::size_t>(settings.largest_array);
  std::string text =
      fmt::format("{} seeds in {} tasks in {} job{} would be handed over\n", seeds.size(), tasks,
                  (tasks + largest - 1) / largest, (tasks + largest - 1) / largest == 1 ? "" : "s");
  for (const SeedId& id : seeds) text += ledger_.name(id) + '\n';
  return text;
}

std::string Bundles::free_name(const fs::path& shared) {
  // A number whose folder is there was used before this database was restored from an older copy, or by an
  // owner that died before it had made a bundle of it.
  for (int number = book_.count() + 1;; ++number) {
    std::string name = fmt::format("{}-{}-{:04}", campaign_.name, mark_of(directory_), number);
    if (!fs::exists(BundleFolder(shared, name).root())) return name;
  }
}

Manifest Bundles::manifest_of(const BundleSettings& settings, const std::vector<SeedId>& seeds) const {
  Manifest manifest;
  manifest.name = "";
  manifest.campaign = campaign_.name;
  manifest.engine = settings.engine;
  manifest.engine_folder = settings.engine_folder;
  manifest.engine_identity = engine_identity(settings.engine_provenance);
  manifest.threads = settings.threads;
  manifest.lease_seconds = settings.lease_seconds;
  manifest.checkpoint_seconds = settings.checkpoint_seconds;
  manifest.scenes = Json::object();
  for (const SeedId& id : seeds) {
    const PointRecord& point = ledger_.point(id.point);
    const auto place = static_cast<int>(manifest.seeds.size());
    manifest.scenes[point.hash] = point.scene;
    if (place % settings.seeds_per_task == 0) manifest.tasks.emplace_back();
    manifest.tasks.back().push_back(place);
    manifest.seeds.push_back({point.hash, id.seed});
  }
  return manifest;
}

void Bundles::write(const BundleFolder& folder, const Manifest& manifest, const BundleSettings& settings) {
  const auto tasks = static_cast<int>(manifest.tasks.size());
  folder.create(tasks);
  for (const BundledSeed& seed : manifest.seeds) {
    const fs::path here = directory_.checkpoint(seed.point, seed.seed);
    const fs::path there = folder.shared().checkpoint(seed.point, seed.seed);
    if (!fs::exists(here) || fs::exists(there)) continue;
    if (fs::exists(growing_beside(here))) {
      copy_regular(growing_beside(here), growing_beside(there), largest_copied_file);
    }
    write_durably(there, read_file(here));
  }
  const BatchTemplate scripts =
      filled_in(settings.scripts, folder, manifest.name, tasks, manifest.threads, settings.program);
  for (const auto& [name, text] : scripts) write_durably(folder.script(name), text);
  write_durably(folder.script("options.json"), Json(settings.options).dump() + '\n');
  write_durably(folder.manifest(), manifest_json(manifest).dump(1) + '\n');
}

// The files first, then the rows, then the job: whatever is cut off when, a row without a job is found by the
// job's name, and a folder without a row was never submitted.
std::string Bundles::make(const BundleSettings& settings, const std::vector<SeedId>& seeds) {
  Manifest manifest = manifest_of(settings, seeds);
  manifest.name = free_name(settings.shared);
  write(BundleFolder(settings.shared, manifest.name), manifest, settings);

  BundleRecord bundle;
  bundle.name = manifest.name;
  bundle.shared = settings.shared.string();
  bundle.tasks = static_cast<int>(manifest.tasks.size());
  std::vector<BundleSeedRecord> rows;
  for (int task = 0; task < bundle.tasks; ++task) {
    for (const int place : manifest.tasks[static_cast<std::size_t>(task)]) {
      const SeedId& id = seeds[static_cast<std::size_t>(place)];
      rows.push_back({place, task, ledger_.point(id.point).id, id.seed});
    }
  }
  Transaction booking(database_.connection());
  for (const BundleSeedRecord& row : rows) seeds_.enqueue(row.point, row.seed + 1);
  bundle.id = book_.prepare(bundle, rows);
  events_.write("handed-over", std::nullopt, std::nullopt,
                fmt::format("{} seeds in {} tasks as {}", rows.size(), bundle.tasks, bundle.name));
  booking.commit();
  return submit(bundle, settings.options);
}

std::string Bundles::submit(const BundleRecord& bundle, const std::vector<std::string>& options) {
  const BundleFolder folder(bundle.shared, bundle.name);
  const Submission answer = submit_job(folder.root(), bundle.name, options);
  if (const auto* refused = std::get_if<JobRefused>(&answer)) {
    withdraw(bundle);
    return fmt::format("the batch system took no job, so no seed of {} is handed over: {}", bundle.name,
                       refused->complaint);
  }
  if (const auto* unknown = std::get_if<JobUnknown>(&answer)) {
    listener_.warn(
        fmt::format("{}: whether the batch system has taken the job is unknown ({}); it is asked for a job "
                    "of this name before "
                    "another is submitted",
                    bundle.name, unknown->complaint));
    return "";
  }
  const std::string& job = std::get<JobTaken>(answer).job;
  Transaction booking(database_.connection());
  book_.submitted(bundle.id, job);
  booking.commit();
  listener_.note(fmt::format("{}: {} seeds in {} tasks are handed over as job {}", bundle.name,
                             book_.seeds_out(bundle.id).size(), bundle.tasks, job));
  return "";
}

std::string Bundles::submit_unconfirmed() {
  std::string refusal;
  for (const BundleRecord& bundle : book_.open_bundles()) {
    if (!was_never_submitted(bundle)) continue;
    const BundleFolder folder(bundle.shared, bundle.name);
    const std::string answer =
        submit(bundle, read_json(folder.script("options.json")).get<std::vector<std::string>>());
    if (!answer.empty()) refusal = answer;
  }
  return refusal;
}

}  // namespace peclet::runner
