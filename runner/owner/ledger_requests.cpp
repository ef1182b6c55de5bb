// The ledger's part in what people change while seeds run: another campaign, cancelled points, another
// engine.
#include <fmt/format.h>

#include <set>

#include "runner/database/bundle_book.h"
#include "runner/owner/ledger.h"

namespace peclet::runner {

void Ledger::take_over(const Campaign& campaign) {
  queue_.take_over(campaign);
  if (!former_) former_ = campaign_;
  campaign_ = campaign;
}

void Ledger::refresh() {
  read_points();
  read();
  book_looks();
  if (has_engine()) refuse_other_engine(identity_);
}

bool Ledger::keep_running(Grant& grant) {
  const auto place = places_.find(grant.job.point);
  grant.id.point = place == places_.end() ? nowhere : place->second;
  if (!takes_part(grant.id)) return false;
  scheduler_->begin(grant.id);
  ++running_[static_cast<std::size_t>(grant.id.point)];
  return !scheduler_->cancelled(grant.id.point);
}

bool Ledger::is_to_be_run(const PointRecord& about) const {
  return !scheduler_->decided(*about.place) && !about.cancelled;
}

void Ledger::refuse_other_engine(const std::string& identity) const {
  for (const PointRecord& about : points_) {
    if (is_to_be_run(about) && !about.engine_identity.empty() && about.engine_identity != identity) {
      throw OtherEngine(
          fmt::format("{}: has results of engine {}, but the engine now is {}; one point never mixes two",
                      about.label, about.engine_identity, identity));
    }
  }
}

int Ledger::accept_engine(const std::string& identity) {
  int points = 0;
  std::set<std::string> folders{directory_.root().string()};
  const BundleBook book(database_.connection());
  if (const std::string shared = book.last_shared(); !shared.empty()) folders.insert(shared);
  for (const BundleRecord& bundle : book.open_bundles()) folders.insert(bundle.shared);
  Transaction booking(database_.connection());
  for (const PointRecord& about : points_) {
    if (!is_to_be_run(about) || about.engine_identity.empty() || about.engine_identity == identity) continue;
    queue_.keep_apart(about, identity);
    to_tell_.emplace_back(
        Note{fmt::format("{}: results of engine {} are kept apart", about.label, about.engine_identity)});
    ++points;
    // Another engine could not go on from where they stand.
    for (const RealisationRecord& record : database_.realisations(about.id)) {
      for (const std::string& folder : folders) {
        to_discard_.push_back(CampaignDirectory(folder).checkpoint(about.hash, record.seed));
      }
    }
  }
  refresh();
  booking.commit();
  after_commit();
  return points;
}

}  // namespace peclet::runner
