// The ledger's part in seeds that a batch system runs.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <system_error>

#include "runner/owner/ledger.h"
#include "runner/store/blame.h"
#include "runner/store/bundle_store.h"

namespace peclet::runner {

namespace {

namespace fs = std::filesystem;

struct Out {
  std::size_t seeds = 0;
  std::vector<std::string> bundles;
};

// "a-0001, a-0002 and 3 more"
std::string listed(const std::vector<std::string>& names) {
  constexpr std::size_t most = 3;
  const std::string text = fmt::format(
      "{}", fmt::join(names.begin(),
                      names.begin() + static_cast<std::ptrdiff_t>(std::min(most, names.size())), ", "));
  return names.size() > most ? fmt::format("{} and {} more", text, names.size() - most) : text;
}

}  // namespace

void Ledger::ingest_spool() {
  removal_.finish();  // of what has been taken already
  ingest_spool_of(directory_);
  const BundleStore book(database_.connection());
  std::map<std::string, Out> shared;
  for (const BundleRecord& bundle : book.open_bundles()) {
    Out& out = shared[bundle.shared];
    out.seeds += book.seeds_out(bundle.id).size();
    out.bundles.push_back(bundle.name);
  }
  // Tasks of a bundle that was given up may have left results since.
  for (const BundleRecord& bundle : book.forgotten_bundles()) shared[bundle.shared];
  for (const auto& [folder, out] : shared) {
    const CampaignDirectory there(folder);
    std::error_code unreachable;
    if (fs::is_directory(there.spool(), unreachable)) {
      away_.erase(folder);
      ingest_spool_of(there);
    } else if (out.seeds > 0 && away_.insert(folder).second) {
      listener_.warn(
          fmt::format("{}: {}, and {} seeds are out in it ({}). Put it back, and `peclet ingest` takes in "
                      "what it holds; if it is "
                      "gone for good, `peclet ingest --forget {}` queues seeds again",
                      folder, unreachable ? unreachable.message() : "is not there", out.seeds,
                      listed(out.bundles), out.bundles.front()));
    }
  }
  removal_.finish();
}

void Ledger::leave_to_batch_system(int place) {
  const BundleStore book(database_.connection());
  for (const int seed : book.seeds_out_of_point(point(place).id)) {
    // A seed beyond the maximum (it was larger once) has no part in the looks.
    if (seed < campaign().maximum_realisations && !has_ended({place, seed}))
      board_.scheduler().begin({place, seed});
  }
}

std::vector<SeedId> Ledger::draw(bool ahead) {
  std::vector<SeedId> drawn;
  while (const std::optional<SeedId> id = scheduler().next()) {
    if (!ahead && id->seed >= scheduler().wanted(id->point)) break;
    board_.scheduler().begin(*id);
    drawn.push_back(*id);
  }
  return drawn;
}

std::optional<SeedId> Ledger::identify(std::int64_t point_id, int seed) const {
  const std::optional<int> place = board_.place_of(point_id);
  return place ? std::optional(SeedId{*place, seed}) : std::nullopt;
}

bool Ledger::has_ended(SeedId id) { return seeds_.has_ended(point(id.point).id, id.seed); }

void Ledger::end_handed_over(SeedId id, int task, const AttemptReport& report,
                             const std::filesystem::path& checkpoint) {
  const PointRecord& about = point(id.point);
  seeds_.attempt_elsewhere(about.id, id.seed, task, report);
  if (has_ended(id)) return;
  const SeedFate fate = judge(seeds_.history(about.id, id.seed), retries_);
  if (fate.discard_checkpoint) changes_.after.discard(checkpoint);
  // A drain with a message is a failure that a full disk excuses.
  const bool is_excused = report.outcome == AttemptOutcome::drained && !report.message.empty();
  if (is_blamed(report.outcome) || is_excused) {
    changes_.after.warn(fmt::format("{} on {}: {}{}{}; {}", name(id), report.host, to_string(report.outcome),
                                    report.message.empty() ? "" : ": ", report.message,
                                    fate.quarantine ? "it is given up" : "it is tried again"));
  }
  if (!fate.quarantine) {
    take_back(id);
    return;
  }
  seeds_.quarantine(about.id, id.seed, fate.cause);
  book_outcome(id, Outcome{});
}

void Ledger::take_back(SeedId id) {
  if (id.seed < campaign().maximum_realisations && !has_ended(id)) board_.scheduler().give_back(id);
}

}  // namespace peclet::runner
