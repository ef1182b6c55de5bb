// Bundles: what has become of the seeds of jobs that have been submitted.
#include <fmt/format.h>

#include <system_error>

#include "contract/input_error.h"
#include "runner/batch/bundles.h"
#include "runner/store/blame.h"

namespace peclet::runner {
namespace {

namespace fs = std::filesystem;

// Some task of the bundle has been at work, whatever the batch system remembers.
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
      continue;  // the ledger says so
    tell_once(
        bundle.name,
        fmt::format("{}; {} seeds of this bundle are out. `peclet ingest --forget {}` queues them again", why,
                    book_.seeds_out(bundle.id).size(), bundle.name));
  }
  if (settled.unreachable > 0) ledger_.ingest_spool();  // what there is elsewhere
  return settled;
}

// Turns of --follow would fill a log with it.
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
  // Asked before the files are read: whatever a task that has gone has left is there by then.
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
  // After the reports: a result is in the spool when, or soon after, its report says so.
  ledger_.ingest_spool();

  Transaction booking(database_.connection());
  for (std::size_t i = 0; i < out.size(); ++i) {
    const BundleSeedRecord& seed = out[i];
    const BundledSeed& named = manifest.seeds.at(static_cast<std::size_t>(seed.place));
    const std::optional<SeedId> id = ledger_.identify(seed.point, seed.seed);
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
      ledger_.end_handed_over(*id, seed.task, report, folder.shared().checkpoint(named.point, named.seed));
    }
    book_.seed_ended(bundle.id, seed.place, to_string(report.outcome));
    ++settled.ended;
  }
  booking.commit();
  ledger_.after_commit();
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
  const std::optional<SeedId> id = ledger_.identify(seed.point, seed.seed);
  const std::optional<PlacedReport> cut_off = read_report(folder.running(seed.task));
  if (const std::string trouble = trouble_of(folder, seed.task); !trouble.empty()) {
    returned.troubles.insert(trouble);
  }
  ++returned.seeds;
  if (!cut_off) ++returned.lifeless;
  if (id && cut_off && cut_off->place == seed.place && cut_off->report.outcome == AttemptOutcome::running) {
    // Its task was ended in the middle of it, without time to say so: that is nobody's blame, but it is
    // counted.
    AttemptReport report = cut_off->report;
    report.outcome = AttemptOutcome::killed;
    report.message = "its task ended without a word";
    ledger_.end_handed_over(*id, seed.task, report,
                            folder.shared().checkpoint(ledger_.point(id->point).hash, id->seed));
    book_.seed_ended(bundle.id, seed.place, to_string(report.outcome));
    return;
  }
  if (id) ledger_.take_back(*id);
  book_.seed_ended(bundle.id, seed.place, "returned");
}

void Bundles::tell(const BundleRecord& bundle, const Returned& returned, SettleReport& settled) {
  if (returned.seeds > 0) {
    listener_.note(
        fmt::format("{}: tasks of job {} have gone without a result for {} seeds; they are queued again",
                    bundle.name, bundle.job, returned.seeds));
  }
  if (returned.lifeless > 0) {
    settled.lifeless = fmt::format("{}: tasks have gone without having begun; what they printed is in {}",
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
  events_.write(
      "bundle-closed", std::nullopt, std::nullopt,
      fmt::format("{} (job {}): {} seeds came back without a result", bundle.name, bundle.job, without));
  booking.commit();
  // What the tasks printed is of interest only when something went wrong.
  if (without == 0) return void(fs::remove_all(folder.root()));
  for (int task = 0; task < bundle.tasks; ++task)
    fs::remove_all(folder.left(task));  // of attempts without a result
}

}  // namespace peclet::runner
