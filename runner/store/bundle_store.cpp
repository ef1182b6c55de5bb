#include "runner/store/bundle_store.h"

namespace peclet::runner {

std::int64_t BundleStore::prepare(const BundleRecord& bundle, const std::vector<BundleSeedRecord>& seeds) {
  Statement(
      connection_,
      "INSERT INTO bundle (name, shared, tasks, made_at) VALUES (?, ?, ?, strftime('%Y-%m-%dT%H:%M:%SZ'))")
      .bind(bundle.name)
      .bind(bundle.shared)
      .bind(bundle.tasks)
      .run();
  const std::int64_t id = connection_.last_insert_id();
  Statement insert(connection_,
                   "INSERT INTO bundle_seed (bundle_id, place, task, point_id, seed) VALUES (?, ?, ?, ?, ?)");
  for (const BundleSeedRecord& seed : seeds) {
    insert.bind(id).bind(seed.place).bind(seed.task).bind(seed.point).bind(seed.seed).run();
  }
  return id;
}

void BundleStore::submitted(std::int64_t bundle, const std::string& job) {
  Statement(connection_,
            "UPDATE bundle SET job = ?, submitted_at = strftime('%Y-%m-%dT%H:%M:%SZ') WHERE bundle_id = ?")
      .bind(job)
      .bind(bundle)
      .run();
}

void BundleStore::seed_ended(std::int64_t bundle, int place, const char* outcome) {
  Statement(connection_,
            "UPDATE bundle_seed SET outcome = ? WHERE bundle_id = ? AND place = ? AND outcome IS NULL")
      .bind(outcome)
      .bind(bundle)
      .bind(place)
      .run();
}

void BundleStore::close(std::int64_t bundle) {
  Statement(connection_, "UPDATE bundle SET closed_at = strftime('%Y-%m-%dT%H:%M:%SZ') WHERE bundle_id = ?")
      .bind(bundle)
      .run();
}

void BundleStore::forget(std::int64_t bundle) {
  Statement(connection_,
            "UPDATE bundle_seed SET outcome = 'forgotten' WHERE bundle_id = ? AND outcome IS NULL")
      .bind(bundle)
      .run();
  close(bundle);
}

std::vector<BundleRecord> BundleStore::open_bundles() const { return bundles_where("closed_at IS NULL"); }

std::vector<BundleRecord> BundleStore::forgotten_bundles() const {
  return bundles_where("bundle_id IN (SELECT bundle_id FROM bundle_seed WHERE outcome = 'forgotten')");
}

std::vector<BundleRecord> BundleStore::bundles_where(const std::string& condition) const {
  Statement query(connection_, "SELECT bundle_id, name, shared, job, tasks FROM bundle WHERE " + condition +
                                   " ORDER BY bundle_id");
  std::vector<BundleRecord> bundles;
  while (query.step()) {
    bundles.push_back(
        {query.integer(0), query.text(1), query.text(2), query.text(3), static_cast<int>(query.integer(4))});
  }
  return bundles;
}

bool BundleStore::has(const std::string& name) const {
  Statement query(connection_, "SELECT 1 FROM bundle WHERE name = ?");
  return query.bind(name).step();
}

std::vector<BundleSeedRecord> BundleStore::seeds_out(std::int64_t bundle) const {
  Statement query(
      connection_,
      "SELECT place, task, point_id, seed FROM bundle_seed WHERE bundle_id = ? AND outcome IS NULL "
      "ORDER BY place");
  query.bind(bundle);
  std::vector<BundleSeedRecord> seeds;
  while (query.step()) {
    seeds.push_back({static_cast<int>(query.integer(0)), static_cast<int>(query.integer(1)), query.integer(2),
                     static_cast<int>(query.integer(3))});
  }
  return seeds;
}

std::vector<int> BundleStore::seeds_out_of_point(std::int64_t point) const {
  Statement query(connection_,
                  "SELECT seed FROM bundle_seed WHERE point_id = ? AND outcome IS NULL ORDER BY seed");
  query.bind(point);
  std::vector<int> seeds;
  while (query.step()) seeds.push_back(static_cast<int>(query.integer(0)));
  return seeds;
}

std::vector<HandedOver> BundleStore::handed_over() const {
  Statement query(
      connection_,
      "SELECT name, coalesce(job, ''), shared, count(*) FROM bundle JOIN bundle_seed USING (bundle_id) "
      "WHERE outcome IS NULL GROUP BY bundle_id ORDER BY bundle_id");
  std::vector<HandedOver> bundles;
  while (query.step()) {
    bundles.push_back({query.text(0), query.text(1), query.text(2), static_cast<int>(query.integer(3))});
  }
  return bundles;
}

int BundleStore::without_result(std::int64_t bundle) const {
  Statement query(connection_,
                  "SELECT count(*) FROM bundle_seed WHERE bundle_id = ? AND outcome IS NOT 'result'");
  query.bind(bundle).step();
  return static_cast<int>(query.integer(0));
}

int BundleStore::count() const {
  return static_cast<int>(connection_.integer("SELECT count(*) FROM bundle"));
}

std::string BundleStore::last_shared() const {
  return connection_.text("SELECT shared FROM bundle ORDER BY bundle_id DESC LIMIT 1");
}

bool BundleStore::are_out_in(const std::string& folder) const {
  Statement query(connection_, "SELECT 1 FROM bundle WHERE shared = ? AND closed_at IS NULL");
  return query.bind(folder).step();
}

}  // namespace peclet::runner
