#include "runner/batch/bundles.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <system_error>

#include "contract/durable_file.h"
#include "contract/errors.h"
#include "contract/guarded_file.h"
#include "contract/sha256.h"
#include "runner/store/blame.h"
#include "runner/store/locks.h"
#include "runner/store/result_files.h"

namespace peclet::runner {

// Asks the batch system again just before something is done about the bundle, so that an answer that was too
// late for settle() is not overlooked.
bool Bundles::was_never_submitted(const BundleRecord& bundle) const {
  const BundleFolder folder(bundle.shared, bundle.name);
  std::string why;
  if (!bundle.job.empty() || !is_there(folder, why)) return false;
  const std::optional<QueryAnswer> known = query_job(folder.root(), bundle.name, why);
  return known && known->jobs.empty();
}

void Bundles::cancel() {
  for (const BundleRecord& bundle : book_.open_bundles()) {
    const BundleFolder folder(bundle.shared, bundle.name);
    std::string why;
    if (!is_there(folder, why)) continue;  // settle() has warned of it
    if (was_never_submitted(bundle)) {
      withdraw(bundle);
    } else if (!cancel_job(folder.root(), bundle.name, why)) {
      listener_.warn(fmt::format("{}: could not be cancelled: {}", bundle.name, why));
    }
  }
}

void Bundles::take_back_seeds(const BundleRecord& bundle) {
  for (const BundleSeedRecord& seed : book_.seeds_out(bundle.id)) {
    if (const std::optional<SeedId> id = state_.identify(seed.point, seed.seed)) state_.take_back(*id);
  }
}

// Queues the seeds again and removes the folder. If the batch system has the job after all, its tasks find
// no manifest and end.
void Bundles::withdraw(const BundleRecord& bundle) {
  Transaction booking(database_.connection());
  take_back_seeds(bundle);
  for (const BundleSeedRecord& seed : book_.seeds_out(bundle.id)) {
    book_.seed_ended(bundle.id, seed.place, "returned");
  }
  book_.close(bundle.id);
  booking.commit();
  std::error_code left;  // remnants do no harm
  fs::remove_all(BundleFolder(bundle.shared, bundle.name).root(), left);
}

bool Bundles::forget(const std::string& name) {
  for (const BundleRecord& bundle : book_.open_bundles()) {
    if (bundle.name != name) continue;
    const std::size_t seeds = book_.seeds_out(bundle.id).size();
    Transaction booking(database_.connection());
    take_back_seeds(bundle);
    book_.forget(bundle.id);
    const std::string message = fmt::format(
        "{} (job {}): {} seeds are queued again; results that its tasks leave are taken in, and count once",
        name, bundle.job.empty() ? "not confirmed" : bundle.job, seeds);
    events_.write("bundle-forgotten", message);
    booking.commit();
    listener_.note("forgotten: " + message);
    fence_forgotten();
    return true;
  }
  return false;
}

// Ends the job of a forgotten bundle once its folder can be reached, and tells its tasks to leave.
void Bundles::fence_forgotten() {
  for (const BundleRecord& bundle : book_.forgotten_bundles()) {
    const BundleFolder folder(bundle.shared, bundle.name);
    std::string why;
    std::error_code error;
    if (!is_there(folder, why) || fs::exists(folder.forgotten(), error)) continue;
    try {
      write_durably(folder.forgotten(), "");
    } catch (const std::system_error& unwritable) {
      tell_once(bundle.name, fmt::format("{}: its tasks cannot be told that it is forgotten: {}", bundle.name,
                                         unwritable.what()));
      continue;
    }
    if (!cancel_job(folder.root(), bundle.name, why)) {
      listener_.note(fmt::format("{}: its job could not be ended: {}", bundle.name, why));
    }
  }
}

namespace {

// Returns a mark of the campaign's folder and machine, so that campaigns of one name share no job's name.
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

// True if some task of the bundle has been at work.
bool has_left_traces(const BundleFolder& folder, const BundleRecord& bundle) {
  if (!fs::is_empty(folder.root() / "ended")) return true;
  for (int task = 0; task < bundle.tasks; ++task) {
    if (!fs::is_empty(folder.task(task))) return true;
  }
  return false;
}

std::string trouble_of(const BundleFolder& folder, int task) {
  if (!fs::exists(folder.trouble(task))) return "";
  const Json trouble = read_json(folder.trouble(task));
  return fmt::format("on {}: {}", trouble.value("host", "?"), trouble.value("message", "?"));
}

}  // namespace

void check_template(const BatchTemplate& scripts, const fs::path& shared, const std::string& program) {
  filled_in(scripts, BundleFolder(shared, "name"), "name", 1, 1, program);
}

Bundles::Bundles(Database& database, CampaignState& state, const Campaign& campaign,
                 CampaignDirectory directory, RunListener& listener)
    : database_(database),
      state_(state),
      campaign_(campaign),
      directory_(std::move(directory)),
      listener_(listener),
      book_(database.connection()),
      seeds_(database),
      events_(database.connection()) {}

std::string Bundles::hand_over(const BundleSettings& settings) {
  // A shared folder that is not mounted must not be made anew below its mount point.
  if (!fs::is_directory(settings.shared) && book_.are_out_in(settings.shared.string())) {
    tell_once(
        settings.shared.string(),
        fmt::format("{}: is not there, and nothing is handed over until it is", settings.shared.string()));
    return "";
  }
  told_.erase(settings.shared.string());
  const std::vector<SeedId> seeds = state_.draw(settings.ahead);
  const std::size_t most =
      static_cast<std::size_t>(settings.seeds_per_task) * static_cast<std::size_t>(settings.largest_array);
  for (std::size_t from = 0; from < seeds.size(); from += most) {
    const std::size_t end = std::min(seeds.size(), from + most);
    const auto begin = seeds.begin() + static_cast<std::ptrdiff_t>(from);
    const std::string refusal = make(settings, {begin, seeds.begin() + static_cast<std::ptrdiff_t>(end)});
    if (refusal.empty()) continue;
    for (std::size_t left = end; left < seeds.size(); ++left) state_.take_back(seeds[left]);
    return refusal;
  }
  return "";
}

std::string Bundles::describe(const BundleSettings& settings) {
  const std::vector<SeedId> seeds = state_.draw(settings.ahead);
  const auto per_task = static_cast<std::size_t>(settings.seeds_per_task);
  const std::size_t tasks = (seeds.size() + per_task - 1) / per_task;
  const auto largest = static_cast<std::size_t>(settings.largest_array);
  std::string text =
      fmt::format("{} seeds in {} tasks in {} job{} would be handed over\n", seeds.size(), tasks,
                  (tasks + largest - 1) / largest, (tasks + largest - 1) / largest == 1 ? "" : "s");
  for (const SeedId& id : seeds) text += state_.name(id) + '\n';
  return text;
}

std::string Bundles::free_name(const fs::path& shared) {
  // Skips numbers whose folder exists: they were used before this database was restored from an older copy,
  // or by an owner that died before it stored the bundle.
  for (int number = book_.count() + 1;; ++number) {
    std::string name = fmt::format("{}-{}-{:04}", campaign_.name, mark_of(directory_), number);
    if (!fs::exists(BundleFolder(shared, name).root())) return name;
  }
}

Manifest Bundles::manifest_of(const BundleSettings& settings, const std::vector<SeedId>& seeds) const {
  Manifest manifest;
  manifest.campaign = campaign_.name;
  manifest.engine = settings.engine;
  manifest.engine_folder = settings.engine_folder;
  manifest.engine_identity = engine_identity(settings.engine_provenance);
  manifest.threads = settings.threads;
  manifest.device = settings.device;
  manifest.lease_seconds = settings.lease_seconds;
  manifest.checkpoint_seconds = settings.checkpoint_seconds;
  manifest.scenes = Json::object();
  for (const SeedId& id : seeds) {
    const PointRecord& point = state_.point(id.point);
    const auto place = static_cast<int>(manifest.seeds.size());
    manifest.scenes[point.hash] = point.scene;
    if (place % settings.seeds_per_task == 0) manifest.tasks.emplace_back();
    manifest.tasks.back().push_back(place);
    manifest.seeds.push_back({point.hash, id.seed, state_.halvings_of(point.id, id.seed)});
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
      filled_in(settings.scripts, folder, manifest.bundle, tasks, manifest.threads, settings.program);
  for (const auto& [name, text] : scripts) write_durably(folder.script(name), text);
  write_durably(folder.script("options.json"), Json(settings.options).dump() + '\n');
  write_durably(folder.manifest(), manifest_json(manifest).dump(1) + '\n');
}

// Writes the files first, then the rows, then submits the job. After a crash, a row without a job is found by
// the job's name, and a folder without a row was never submitted.
std::string Bundles::make(const BundleSettings& settings, const std::vector<SeedId>& seeds) {
  Manifest manifest = manifest_of(settings, seeds);
  manifest.bundle = free_name(settings.shared);
  write(BundleFolder(settings.shared, manifest.bundle), manifest, settings);

  BundleRecord bundle;
  bundle.name = manifest.bundle;
  bundle.shared = settings.shared.string();
  bundle.tasks = static_cast<int>(manifest.tasks.size());
  std::vector<BundleSeedRecord> rows;
  for (int task = 0; task < bundle.tasks; ++task) {
    for (const int place : manifest.tasks[static_cast<std::size_t>(task)]) {
      const SeedId& id = seeds[static_cast<std::size_t>(place)];
      rows.push_back({place, task, state_.point(id.point).id, id.seed});
    }
  }
  Transaction booking(database_.connection());
  for (const BundleSeedRecord& row : rows) seeds_.enqueue(row.point, row.seed + 1);
  bundle.id = book_.prepare(bundle, rows);
  events_.write("handed-over",
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
                    "of this name before another is submitted",
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

Bundles::SettleReport Bundles::settle() {
  SettleReport settled;
  fence_forgotten();
  for (const BundleRecord& bundle : book_.open_bundles()) {
    ++settled.open;
    std::string why;
    if (is_there(BundleFolder(bundle.shared, bundle.name), why)) {
      settle_bundle(bundle, settled);
      continue;
    }
    ++settled.unknown;
    ++settled.unreachable;
    std::error_code unreachable;
    if (!fs::is_directory(CampaignDirectory(bundle.shared).spool(), unreachable))
      continue;  // state_ has warned of it
    tell_once(
        bundle.name,
        fmt::format("{}; {} seeds of this bundle are out. `peclet ingest --forget {}` queues them again", why,
                    book_.seeds_out(bundle.id).size(), bundle.name));
  }
  if (settled.unreachable > 0) state_.ingest_spool();  // results in other folders
  return settled;
}

// Warns unless the last warning about the subject was the same, which --follow would repeat at every turn.
void Bundles::tell_once(const std::string& about, const std::string& message) {
  std::string& last = told_[about];
  if (last != message) listener_.warn(message);
  last = message;
}

void Bundles::settle_bundle(const BundleRecord& known, SettleReport& settled) {
  BundleRecord bundle = known;
  const BundleFolder folder(bundle.shared, bundle.name);
  const Manifest manifest = read_manifest(folder.manifest());
  std::string why;
  // The batch system is asked before the files are read: what an ended task left is there by then.
  const std::optional<QueryAnswer> answer = query_job(folder.root(), bundle.name, why);
  if (!answer) {
    ++settled.unknown;
    tell_once(bundle.name,
              fmt::format("{}: what has become of its tasks is unknown ({}); nothing is concluded from that",
                          bundle.name, why));
  } else if (bundle.job.empty() && (!answer->jobs.empty() || has_left_traces(folder, bundle))) {
    bundle.job =
        answer->jobs.empty() ? "of unknown number" : fmt::format("{}", fmt::join(answer->jobs, ", "));
    Transaction booking(database_.connection());
    book_.submitted(bundle.id, bundle.job);
    booking.commit();
    listener_.note(fmt::format("{}: found by its name as job {}", bundle.name, bundle.job));
  }
  if (answer) told_.erase(bundle.name);
  const bool is_known = answer && !bundle.job.empty();
  if (bundle.job.empty()) ++settled.unconfirmed;
  for (int task = 0; is_known && task < bundle.tasks; ++task) {
    if (!answer->alive(task)) publish_results(folder, manifest, task);
  }
  book(bundle, folder, manifest, is_known ? &*answer : nullptr, settled);
}

void Bundles::book(const BundleRecord& bundle, const BundleFolder& folder, const Manifest& manifest,
                   const QueryAnswer* answer, SettleReport& settled) {
  const std::vector<BundleSeedRecord> out = book_.seeds_out(bundle.id);
  Returned returned;
  std::vector<std::optional<PlacedReport>> reports;
  reports.reserve(out.size());
  for (const BundleSeedRecord& seed : out) reports.push_back(read_report(folder.ended(seed.place)));
  // Results are taken in after the reports: a result is in the spool when, or soon after, its report says so.
  state_.ingest_spool();

  Transaction booking(database_.connection());
  for (std::size_t i = 0; i < out.size(); ++i) {
    const BundleSeedRecord& seed = out[i];
    const BundledSeed& named = manifest.seeds.at(static_cast<std::size_t>(seed.place));
    const std::optional<SeedId> id = state_.identify(seed.point, seed.seed);
    const bool gone = answer != nullptr && !answer->alive(seed.task);
    const bool has_result = seeds_.has_ended(seed.point, seed.seed);
    if (!reports[i] || (reports[i]->report.outcome == AttemptOutcome::result && !has_result)) {
      if (gone && has_result) {
        book_.seed_ended(bundle.id, seed.place, "result");
      } else if (gone) {
        return_seed(bundle, folder, seed, returned);
      }
      continue;
    }
    const AttemptReport& report = reports[i]->report;
    if (id) {
      state_.end_handed_over(*id, seed.task, report, folder.shared().checkpoint(named.point, named.seed));
    }
    book_.seed_ended(bundle.id, seed.place, to_string(report.outcome));
    ++settled.ended;
  }
  booking.commit();
  state_.after_commit();
  tell(bundle, returned, settled);

  bool alive = answer == nullptr;
  for (int task = 0; !alive && task < bundle.tasks; ++task) alive = answer->alive(task);
  if (!alive && book_.seeds_out(bundle.id).empty()) {
    close(bundle, folder);
    --settled.open;
  }
}

void Bundles::return_seed(const BundleRecord& bundle, const BundleFolder& folder,
                          const BundleSeedRecord& seed, Returned& returned) {
  const std::optional<SeedId> id = state_.identify(seed.point, seed.seed);
  const std::vector<PlacedReport> running = read_running(folder, seed.task);
  const auto cut_off = std::find_if(running.begin(), running.end(), [&](const PlacedReport& placed) {
    return placed.place == seed.place && placed.report.outcome == AttemptOutcome::running;
  });
  if (const std::string trouble = trouble_of(folder, seed.task); !trouble.empty()) {
    returned.troubles.insert(trouble);
  }
  ++returned.seeds;
  if (running.empty()) ++returned.lifeless;
  if (id && cut_off != running.end()) {
    // The task had no time to report: the attempt is counted, but not blamed.
    AttemptReport report = cut_off->report;
    report.outcome = AttemptOutcome::killed;
    report.message = "its task ended without a report";
    report.company = static_cast<int>(std::count_if(running.begin(), running.end(),
                                                    [](const auto& placed) {
                                                      return placed.report.outcome == AttemptOutcome::running;
                                                    })) -
                     1;
    state_.end_handed_over(*id, seed.task, report,
                           folder.shared().checkpoint(state_.point(id->point).hash, id->seed));
    book_.seed_ended(bundle.id, seed.place, to_string(report.outcome));
    return;
  }
  if (id) state_.take_back(*id);
  book_.seed_ended(bundle.id, seed.place, "returned");
}

void Bundles::tell(const BundleRecord& bundle, const Returned& returned, SettleReport& settled) {
  if (returned.seeds > 0) {
    listener_.note(
        fmt::format("{}: tasks of job {} ended without a result for {} seeds, which are queued again",
                    bundle.name, bundle.job, returned.seeds));
  }
  if (returned.lifeless > 0) {
    settled.lifeless = fmt::format("{}: tasks ended before they began a seed; what they printed is in {}",
                                   bundle.name, BundleFolder(bundle.shared, bundle.name).logs().string());
  }
  for (const std::string& trouble : returned.troubles) {
    settled.lifeless = fmt::format("{}: a task could do nothing {}", bundle.name, trouble);
    listener_.warn(settled.lifeless);
  }
}

void Bundles::close(const BundleRecord& bundle, const BundleFolder& folder) {
  const int without = book_.without_result(bundle.id);
  Transaction booking(database_.connection());
  book_.close(bundle.id);
  events_.write("bundle-closed", fmt::format("{} (job {}): {} seeds came back without a result", bundle.name,
                                             bundle.job, without));
  booking.commit();
  // Logs of tasks are kept only if something went wrong.
  if (without == 0) return void(fs::remove_all(folder.root()));
  for (int task = 0; task < bundle.tasks; ++task)
    fs::remove_all(folder.left(task));  // files of attempts without a result
}

}  // namespace peclet::runner
