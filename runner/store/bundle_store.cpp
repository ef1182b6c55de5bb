#include "runner/store/bundle_store.h"

namespace peclet::runner {

std::int64_t BundleStore::prepare(const BundleRecord& bundle, const std::vector<BundleSeedRecord>& seeds) {
  connection_.run(
      "INSERT INTO bundle (name, shared, tasks, made_at) VALUES (?, ?, ?, strftime('%Y-%m-%dT%H:%M:%SZ'))",
      bundle.name, bundle.shared, bundle.tasks);
  const std::int64_t id = connection_.last_insert_id();
  Statement insert(connection_,
                   "INSERT INTO bundle_seed (bundle_id, place, task, point_id, seed) VALUES (?, ?, ?, ?, ?)");
  for (const BundleSeedRecord& seed : seeds) insert.run(id, seed.place, seed.task, seed.point, seed.seed);
  return id;
}

void BundleStore::submitted(std::int64_t bundle, const std::string& job) {
  connection_.run(
      "UPDATE bundle SET job = ?, submitted_at = strftime('%Y-%m-%dT%H:%M:%SZ') WHERE bundle_id = ?", job,
      bundle);
}

void BundleStore::seed_ended(std::int64_t bundle, int place, const char* outcome) {
  connection_.run("UPDATE bundle_seed SET outcome = ? WHERE bundle_id = ? AND place = ? AND outcome IS NULL",
                  outcome, bundle, place);
}

void BundleStore::close(std::int64_t bundle) {
  connection_.run("UPDATE bundle SET closed_at = strftime('%Y-%m-%dT%H:%M:%SZ') WHERE bundle_id = ?", bundle);
}

void BundleStore::forget(std::int64_t bundle) {
  connection_.run("UPDATE bundle_seed SET outcome = 'forgotten' WHERE bundle_id = ? AND outcome IS NULL",
                  bundle);
  close(bundle);
}

std::vector<BundleRecord> BundleStore::open_bundles() const { return bundles_where("closed_at IS NULL"); }

std::vector<BundleRecord> BundleStore::forgotten_bundles() const {
  return bundles_where("bundle_id IN (SELECT bundle_id FROM bundle_seed WHERE outcome = 'forgotten')");
}

std::vector<BundleRecord> BundleStore::bundles_where(const std::string& condition) const {
  Statement query(connection_, "SELECT bundle_id, name, shared, job, tasks FROM bundle WHERE " + condition +
                                   " ORDER BY bundle_id");
  return query.rows([](const Statement& row) {
    return BundleRecord{row.integer(0), row.text(1), row.text(2), row.text(3), row.number(4)};
  });
}

bool BundleStore::has(const std::string& name) const {
  return Statement(connection_, "SELECT 1 FROM bundle WHERE name = ?", name).step();
}

std::vector<BundleSeedRecord> BundleStore::seeds_out(std::int64_t bundle) const {
  Statement query(connection_,
                  "SELECT place, task, point_id, seed FROM bundle_seed WHERE bundle_id = ? AND outcome IS "
                  "NULL ORDER BY place",
                  bundle);
  return query.rows([](const Statement& row) {
    return BundleSeedRecord{row.number(0), row.number(1), row.integer(2), row.number(3)};
  });
}

std::vector<int> BundleStore::seeds_out_of_point(std::int64_t point) const {
  Statement query(connection_,
                  "SELECT seed FROM bundle_seed WHERE point_id = ? AND outcome IS NULL ORDER BY seed", point);
  return query.rows([](const Statement& row) { return row.number(0); });
}

std::vector<HandedOver> BundleStore::handed_over() const {
  Statement query(
      connection_,
      "SELECT name, coalesce(job, ''), shared, count(*) FROM bundle JOIN bundle_seed USING (bundle_id) "
      "WHERE outcome IS NULL GROUP BY bundle_id ORDER BY bundle_id");
  return query.rows([](const Statement& row) {
    return HandedOver{row.text(0), row.text(1), row.text(2), row.number(3)};
  });
}

int BundleStore::without_result(std::int64_t bundle) const {
  return static_cast<int>(connection_.integer(
      "SELECT count(*) FROM bundle_seed WHERE bundle_id = ? AND outcome IS NOT 'result'", bundle));
}

int BundleStore::count() const {
  return static_cast<int>(connection_.integer("SELECT count(*) FROM bundle"));
}

std::string BundleStore::last_shared() const {
  return connection_.text("SELECT shared FROM bundle ORDER BY bundle_id DESC LIMIT 1");
}

bool BundleStore::are_out_in(const std::string& folder) const {
  return Statement(connection_, "SELECT 1 FROM bundle WHERE shared = ? AND closed_at IS NULL", folder).step();
}

}  // namespace peclet::runner
