#include "runner/maintenance/doctor.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <utility>

#include "contract/durable_file.h"
#include "contract/errors.h"
#include "contract/guarded_file.h"
#include "runner/batch/bundle_files.h"
#include "runner/campaign/number_text.h"
#include "runner/maintenance/backup.h"
#include "runner/owner/open_campaign.h"
#include "runner/statistics/cohorts.h"
#include "runner/store/backups.h"
#include "runner/store/bundle_store.h"
#include "runner/store/database_summary.h"
#include "runner/store/locks.h"
#include "runner/store/number_store.h"
#include "runner/store/point_store.h"
#include "runner/store/realisation_result.h"
#include "runner/store/result_store.h"
#include "runner/store/seed_store.h"

namespace peclet::runner {
namespace {

const char* name_of(Severity severity) {
  return severity == Severity::integrity ? "integrity" : severity == Severity::warning ? "warning" : "note";
}

// Queues the seed again, and keeps what was stored in spool/rejected/.
void run_again(Database& owner, const CampaignDirectory& directory, std::int64_t point, int seed) {
  if (const std::string stored = readable_result(owner, point, seed); !stored.empty()) {
    write_durably(directory.rejected() / fmt::format("point-{}-seed-{}-altered.json", point, seed), stored);
  }
  Transaction booking(owner.connection());
  ResultStore(owner).withdraw(point, seed);
  EventStore(owner.connection())
      .write("repaired", point, seed, "its stored result was not what its hash says: it is run again");
  booking.commit();
}

// Returns what is wrong with the result of a seed that has ended; "" if nothing is.
std::string fault_of(Database& database, const PointRecord& point, const RealisationRecord& record,
                     const std::vector<std::string>& observables) {
  try {
    const std::optional<std::string> text = database.result_text(point.id, record.seed);
    if (!text) return "has ended, but there is no result of it";
    const RealisationResult result = parse_result(*text);
    if (result.point != point.hash || result.seed != record.seed) return "has the result of another seed";
    if (result.content_sha256 != record.content_sha256) return "has a result that does not have its hash";
    if (result.engine != point.engine_identity) return "has a result of another engine";
    if (!NumberStore(database.connection()).agrees(point.id, record.seed, result.document, observables))
      return "has other numbers than its result";
    return "";
  } catch (const ResultError& error) {
    return fmt::format("has an invalid result: {}", error.what());
  } catch (const IntegrityError& error) {
    return fmt::format("has a result that cannot be read: {}", error.what());
  }
}

std::vector<PointRecord> all_points(Database& database) {
  std::vector<PointRecord> points = database.points();
  for (PointRecord& point : database.inactive_points()) points.push_back(std::move(point));
  return points;
}

void examine_results(Database& database, const CampaignUnderExamination& examined, Findings& findings) {
  const std::vector<std::string> observables = database.campaign().target.target.observables();
  for (const PointRecord& point : all_points(database)) {
    if (const int count = unreadable_results(database, point.id); count > 0) {
      findings.push_back({"dictionary-altered", Severity::integrity,
                          fmt::format("{}: {} results cannot be read: the dictionary that they were deflated "
                                      "with is not there",
                                      point.label, count),
                          "put a backup back with `peclet restore`"});
      continue;
    }
    for (const RealisationRecord& record : database.realisations(point.id)) {
      if (record.state != SeedState::done && record.state != SeedState::failed) continue;
      const std::string fault = fault_of(database, point, record, observables);
      if (fault.empty()) continue;
      Finding finding{"result-altered", Severity::integrity,
                      fmt::format("{} seed {}: {}", point.label, record.seed, fault),
                      "put a backup back with `peclet restore`: the point is not in the sweep any more"};
      if (point.place) {
        finding.cure =
            "`peclet doctor --repair` keeps what is stored in spool/rejected/ and queues the seed again";
        finding.repair = [directory = examined.directory, id = point.id,
                          seed = record.seed](Database& owner) { run_again(owner, directory, id, seed); };
      }
      findings.push_back(std::move(finding));
    }
  }
}

void examine_stop_tests(Database& database, Findings& findings) {
  StopTestCheck check(database);
  for (const PointRecord& point : database.points()) {
    if (point.suspect) {
      findings.push_back(
          {"suspect", Severity::integrity,
           point.label + ": a seed gave two different results; the other one is in spool/rejected/",
           "find out why the engine does not repeat itself, and run in another --directory"});
    }
    try {
      if (const std::vector<int> repeated = repeated_seeds(database.outcomes(point.id)); !repeated.empty()) {
        findings.push_back(
            {"seeds-repeated", Severity::warning,
             fmt::format(
                 "{}: seed {} ended in the same state as an earlier one, and {} in all did: such values "
                 "are not independent, and the point gets no interval",
                 point.label, repeated.front(), counted(repeated.size(), "seed")),
             "find out why seeds repeat each other (a start list with equal files, an engine that ignores "
             "the seed), and run in another --directory"});
      }
      check.last(point);
    } catch (const IntegrityError& error) {
      findings.push_back({"stop-test-differs", Severity::integrity, error.what(),
                          "`peclet doctor --repair` tests the stored results again",
                          [point](Database& owner) {
                            const std::vector<StopTest> stop_tests = StopTestCheck(owner).replayed(point);
                            Transaction booking(owner.connection());
                            ResultStore(owner).store_stop_tests(point.id, stop_tests);
                            EventStore(owner.connection())
                                .write("repaired", point.id, std::nullopt, "tested the stored results again");
                            booking.commit();
                          }});
    }
  }
}

void examine_states(Database& database, const CampaignUnderExamination& examined, Findings& findings) {
  const StateFaults faults = state_faults(database);
  if (faults.unclaimed > 0) {
    findings.push_back({"result-unclaimed", Severity::integrity,
                        fmt::format("{} seeds have a result but have not ended", faults.unclaimed),
                        "put a backup back with `peclet restore`"});
  }
  const auto recover = [](Database& owner) { SeedStore(owner).recover(); };
  if (faults.adrift > 0) {
    Finding finding{"lease-adrift", Severity::integrity,
                    fmt::format("{} leases and running seeds do not belong together", faults.adrift),
                    "`peclet run` and `peclet doctor --repair` queue them again"};
    if (!examined.owner) finding.repair = recover;
    findings.push_back(std::move(finding));
  } else if (faults.running > 0 && !examined.owner) {
    findings.push_back({"left-running", Severity::note,
                        fmt::format("{} seeds are left running by an owner that died", faults.running),
                        "`peclet run` and `peclet doctor --repair` queue them again, without blame",
                        recover});
  }
}

// Reports handed-over seeds whose bundle cannot be reached, or whose job is not confirmed.
void examine_hand_over(Database& database, const CampaignUnderExamination& examined, Findings& findings) {
  for (const HandedOver& bundle : BundleStore(database.connection()).handed_over()) {
    std::string why;
    if (!is_there(BundleFolder(bundle.shared, bundle.bundle), why)) {
      findings.push_back(
          {"bundle-stranded", Severity::warning,
           fmt::format("{} seeds are out in the bundle {}, and {}", bundle.seeds, bundle.bundle, why),
           fmt::format(
               "put it back, and `peclet ingest` takes in what it holds; if it is gone for good, `peclet "
               "ingest --forget {}` queues them again",
               bundle.bundle)});
    } else if (bundle.job.empty() && !examined.owner) {  // an owner will know soon
      findings.push_back(
          {"bundle-unconfirmed", Severity::warning,
           fmt::format(
               "{} seeds are out in the bundle {}, and whether the batch system has taken its job is unknown",
               bundle.seeds, bundle.bundle),
           fmt::format(
               "`peclet ingest` asks for it by its name, `peclet hand-over` submits it again; `peclet ingest "
               "--forget {}` queues them again without an answer",
               bundle.bundle)});
    }
  }
}

// A damaged database is not examined any further.
void examine_database(const CampaignUnderExamination& examined, Findings& findings) {
  const auto damaged = [&](const std::string& message) {
    std::string cure = restore_hint(examined.directory);
    cure = cure.empty() ? "there is no backup; keep the folder, and try `sqlite3 campaign.db .recover`"
                        : cure.substr(2);
    findings.push_back({"database-damaged", Severity::integrity, message, cure});
  };
  try {
    Database database = Database::open_reader(examined.directory.database());
    if (const std::string found = damage(database.connection()); !found.empty()) return damaged(found);
    examine_results(database, examined, findings);
    examine_stop_tests(database, findings);
    examine_states(database, examined, findings);
    examine_files(database, examined, findings);
    examine_left_files(database, examined, findings);
    examine_backups(database, examined, findings);
    examine_hand_over(database, examined, findings);
    examine_clock(database, examined, findings);
    examine_log(examined, findings);
    examine_disk(database, examined, findings);
  } catch (const IntegrityError& error) {
    damaged(error.what());
  }
}

void repair(const CampaignDirectory& directory, Findings& findings) {
  const auto can = [](const Finding& finding) { return static_cast<bool>(finding.repair); };
  if (std::none_of(findings.begin(), findings.end(), can)) return;
  create_folders(directory);
  Database owner = Database::open_owner(directory.database());
  for (Finding& finding : findings) {
    if (!finding.repair) continue;
    finding.repair(owner);
    finding.repaired = true;
  }
}

int exit_code(const Findings& findings) {
  Severity worst = Severity::note;
  for (const Finding& finding : findings) {
    if (!finding.repaired) worst = std::max(worst, finding.severity);
  }
  if (worst == Severity::integrity) return ExitCode::integrity;
  return worst == Severity::warning ? ExitCode::error : ExitCode::done;
}

std::string as_text(const CampaignUnderExamination& examined, const Findings& findings) {
  const auto is_note = [](const Finding& finding) { return finding.severity == Severity::note; };
  const auto notes = static_cast<std::size_t>(std::count_if(findings.begin(), findings.end(), is_note));
  const bool is_sound = notes == findings.size();
  std::string text = fmt::format("{}: {}{}\n", examined.directory.root().string(),
                                 is_sound ? "sound" : counted(findings.size() - notes, "finding"),
                                 notes == 0 ? "" : ", " + counted(notes, "note"));
  for (const Finding& finding : findings) {
    text += fmt::format("\n{}: {}\n", name_of(finding.severity), finding.message);
    if (!finding.cure.empty())
      text += fmt::format("  {}: {}\n", finding.repaired ? "done" : "cure", finding.cure);
  }
  return text;
}

std::string as_json(const CampaignUnderExamination& examined, const Findings& findings) {
  Json list = Json::array();
  for (const Finding& finding : findings) {
    list.push_back({{"code", finding.code},
                    {"severity", name_of(finding.severity)},
                    {"message", finding.message},
                    {"cure", finding.cure},
                    {"repairable", static_cast<bool>(finding.repair)},
                    {"repaired", finding.repaired}});
  }
  return Json{{"schema_version", 1},
              {"folder", examined.directory.root().string()},
              {"owner", examined.owner ? Json(*examined.owner) : Json(nullptr)},
              {"exit_code", exit_code(findings)},
              {"findings", list}}
             .dump(2) +
         "\n";
}

}  // namespace

Diagnosis examine_campaign(const DoctorOptions& options) {
  const CampaignDirectory directory = find_campaign(options.campaign, options.directory);
  std::unique_ptr<OwnerLock> lock;
  if (options.repair) lock = std::make_unique<OwnerLock>(directory);
  const auto now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  const CampaignUnderExamination examined{directory, lock ? std::nullopt : current_owner(directory),
                                          fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(now))};
  Findings findings;
  if (!kind_of(directory.database()).empty()) {
    examine_database(examined, findings);
  } else {
    findings.push_back({"database-gone", Severity::integrity, "there is no " + directory.database().string(),
                        restore_hint(directory).substr(2)});
  }
  examine_processes(examined, findings);
  if (options.repair) repair(directory, findings);
  return {options.json ? as_json(examined, findings) : as_text(examined, findings), exit_code(findings)};
}

}  // namespace peclet::runner
