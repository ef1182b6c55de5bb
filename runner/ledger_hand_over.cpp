// The ledger's part in seeds that a batch system runs.
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "runner/bundle_book.h"
#include "runner/bundle_files.h"
#include "runner/ledger.h"

namespace peclet::runner {

void Ledger::ingest_spool() {
  removal_.finish();  // of what has been taken already
  ingest_spool_of(directory_);
  std::set<std::string> shared;
  for (const BundleRecord& bundle : BundleBook(database_.connection()).open_bundles()) {
    if (!shared.insert(bundle.shared).second) continue;
    const CampaignDirectory there(bundle.shared);
    if (std::filesystem::is_directory(there.spool())) {
      ingest_spool_of(there);
    } else {
      listener_.warn(
          fmt::format("{}: is not there now; results in it are taken in later", there.spool().string()));
    }
  }
  removal_.finish();
}

void Ledger::leave_to_batch_system(int place) {
  const BundleBook book(database_.connection());
  for (const int seed : book.seeds_out_of_point(point(place).id)) {
    // A seed beyond the maximum (it was larger once) has no part in the looks.
    if (seed < campaign_.maximum_realisations && !has_ended({place, seed})) scheduler_->begin({place, seed});
  }
}

std::vector<SeedId> Ledger::draw(bool ahead) {
  std::vector<SeedId> drawn;
  while (const std::optional<SeedId> id = scheduler_->next()) {
    if (!ahead && id->seed >= scheduler_->wanted(id->point)) break;
    scheduler_->begin(*id);
    drawn.push_back(*id);
  }
  return drawn;
}

std::optional<SeedId> Ledger::identify(std::int64_t point_id, int seed) const {
  const auto known = std::find_if(points_.begin(), points_.end(),
                                  [&](const PointRecord& about) { return about.id == point_id; });
  if (known == points_.end()) return std::nullopt;
  return SeedId{*known->place, seed};
}

bool Ledger::has_ended(SeedId id) { return queue_.has_ended(point(id.point).id, id.seed); }

void Ledger::end_handed_over(SeedId id, int task, const NodeReport& report,
                             const std::filesystem::path& checkpoint) {
  const PointRecord& about = point(id.point);
  queue_.attempt_elsewhere(about.id, id.seed, task, report);
  if (has_ended(id)) return;
  const Sentence sentence = judge(queue_.history(about.id, id.seed), retries_);
  if (sentence.discard_checkpoint) to_discard_.push_back(checkpoint);
  if (is_blamed(report.outcome)) {
    listener_.warn(fmt::format("{} on {}: {}{}{}; {}", name(id), report.host, to_string(report.outcome),
                               report.message.empty() ? "" : ": ", report.message,
                               sentence.quarantine ? "it is given up" : "it is tried again"));
  }
  if (!sentence.quarantine) {
    take_back(id);
    return;
  }
  queue_.quarantine(about.id, id.seed, sentence.cause);
  book_outcome(id, Outcome{});
}

void Ledger::take_back(SeedId id) {
  if (id.seed < campaign_.maximum_realisations && !has_ended(id)) scheduler_->give_back(id);
}

}  // namespace peclet::runner
