// Does what is stored agree with itself?
#include <fmt/format.h>

#include <utility>

#include "contract/durable_file.h"
#include "contract/integrity_error.h"
#include "runner/care/doctor.h"
#include "runner/statistics/cohorts.h"
#include "runner/store/database_audit.h"
#include "runner/store/database_summary.h"
#include "runner/store/event_store.h"
#include "runner/store/number_store.h"
#include "runner/store/realisation_result.h"
#include "runner/store/result_store.h"
#include "runner/store/seed_store.h"
#include "runner/text/number_text.h"

namespace peclet::runner {
namespace {

// The seed runs again, and gives the same result if its engine is the same; what was stored is kept for
// people.
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

// What is wrong with the result of a seed that has ended: "" when nothing is.
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
    return fmt::format("has a result that is none: {}", error.what());
  } catch (const IntegrityError& error) {
    return fmt::format("has a result that cannot be read: {}", error.what());
  }
}

std::vector<PointRecord> all_points(Database& database) {
  std::vector<PointRecord> points = database.points();
  for (PointRecord& point : database.inactive_points()) points.push_back(std::move(point));
  return points;
}

}  // namespace

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

void examine_looks(Database& database, Findings& findings) {
  const TargetRecord target = database.campaign().target;
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
             "the "
             "seed), and run in another --directory"});
      }
      checked_look(database, point, target);
    } catch (const IntegrityError& error) {
      findings.push_back({"look-differs", Severity::integrity, error.what(),
                          "`peclet doctor --repair` looks again at the stored results",
                          [id = point.id, target](Database& owner) {
                            const std::vector<Look> looks = replay_looks(owner.outcomes(id), target.target,
                                                                         target.minimum, target.maximum);
                            Transaction booking(owner.connection());
                            ResultStore(owner).store_looks(id, looks);
                            EventStore(owner.connection())
                                .write("repaired", id, std::nullopt, "looked again at the stored results");
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

}  // namespace peclet::runner
