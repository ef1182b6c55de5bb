// The ledger's part in what people change while seeds run: another campaign, cancelled points, another
// engine.
#include <fmt/format.h>

#include <set>

#include "runner/owner/ledger.h"
#include "runner/store/bundle_store.h"

namespace peclet::runner {

void Ledger::take_over(const Campaign& campaign) {
  rows_.take_over(campaign);
  next_campaign_ = campaign;
}

void Ledger::refresh() {
  board_.read_points(database_);
  read_board();
  book_looks();
  engine_.require_no_other(board_);
}

bool Ledger::find_place(GivenSeed& given_seed) const {
  given_seed.id.point = board_.place_of(given_seed.job.point).value_or(nowhere);
  return takes_part(given_seed.id) && !scheduler().cancelled(given_seed.id.point);
}

int Ledger::accept_engine(const std::string& identity) {
  int points = 0;
  std::set<std::string> folders{directory_.root().string()};
  const BundleStore book(database_.connection());
  if (const std::string shared = book.last_shared(); !shared.empty()) folders.insert(shared);
  for (const BundleRecord& bundle : book.open_bundles()) folders.insert(bundle.shared);
  Transaction booking(database_.connection());
  for (const PointRecord& about : board_.points()) {
    if (!board_.is_to_be_run(about) || about.engine_identity.empty() || about.engine_identity == identity)
      continue;
    rows_.keep_apart(about, identity);
    changes_.after.note(
        fmt::format("{}: results of engine {} are kept apart", about.label, about.engine_identity));
    ++points;
    // Another engine could not go on from where they stand.
    for (const RealisationRecord& record : database_.realisations(about.id)) {
      for (const std::string& folder : folders) {
        changes_.after.discard(CampaignDirectory(folder).checkpoint(about.hash, record.seed));
      }
    }
  }
  refresh();
  booking.commit();
  after_commit();
  return points;
}

}  // namespace peclet::runner
