// Bundles: seeds that are taken back, whatever the batch system does.
#include <fmt/format.h>

#include <system_error>

#include "contract/durable_file.h"
#include "runner/batch/bundles.h"

namespace peclet::runner {

namespace fs = std::filesystem;

// Asked of the batch system again, just before something is done about it: an answer that came too late for
// settle() would otherwise be overlooked.
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
    if (!is_there(folder, why)) continue;  // settle() has said so
    if (was_never_submitted(bundle)) {
      withdraw(bundle);
    } else if (!cancel_job(folder.root(), bundle.name, why)) {
      listener_.warn(fmt::format("{}: could not be cancelled: {}", bundle.name, why));
    }
  }
}

void Bundles::take_back_seeds(const BundleRecord& bundle) {
  for (const BundleSeedRecord& seed : book_.seeds_out(bundle.id)) {
    if (const std::optional<SeedId> id = ledger_.identify(seed.point, seed.seed)) ledger_.take_back(*id);
  }
}

// The folder goes with it: should there be a job after all, its tasks find no manifest and leave.
void Bundles::withdraw(const BundleRecord& bundle) {
  Transaction booking(database_.connection());
  take_back_seeds(bundle);
  for (const BundleSeedRecord& seed : book_.seeds_out(bundle.id)) {
    book_.seed_ended(bundle.id, seed.place, "returned");
  }
  book_.close(bundle.id);
  booking.commit();
  std::error_code left;  // does no harm
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
    events_.write("bundle-forgotten", std::nullopt, std::nullopt, message);
    booking.commit();
    listener_.note("forgotten: " + message);
    fence_forgotten();
    return true;
  }
  return false;
}

// As soon as the folder of a forgotten bundle can be reached, its job is ended, and tasks that begin all the
// same find a file that tells them to leave.
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

}  // namespace peclet::runner
