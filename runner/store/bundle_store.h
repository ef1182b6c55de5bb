// BundleStore records which seeds are handed over, and in which bundles. A seed is handed over while it has a
// row without an outcome. Its state stays `queued` meanwhile, and only its bundle may run it. The writing
// functions are for use inside a Transaction of the caller.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "runner/store/sqlite.h"

namespace peclet::runner {

struct BundleSeedRecord {
  int place = 0;  // index in the manifest
  int task = 0;
  std::int64_t point = 0;
  int seed = 0;
};

struct BundleRecord {
  std::int64_t id = 0;
  std::string name;    // name of the bundle and of its job
  std::string shared;  // folder that owner and nodes see
  std::string job;     // number in the batch system; "": no answer to the submission was seen
  int tasks = 0;
};

struct HandedOver {  // for people
  std::string bundle, job;
  std::string shared;
  int seeds = 0;  // seeds that are still out
};

class BundleStore {
 public:
  explicit BundleStore(Connection& connection) : connection_(connection) {}

  // Stores a bundle that is about to be submitted. Returns its row.
  std::int64_t prepare(const BundleRecord& bundle, const std::vector<BundleSeedRecord>& seeds);
  void submitted(std::int64_t bundle, const std::string& job);
  void seed_ended(std::int64_t bundle, int place, const char* outcome);
  void close(std::int64_t bundle);
  // Closes the bundle and ends the handing over of its seeds. It stays in forgotten_bundles().
  void forget(std::int64_t bundle);

  // Returns the bundles with tasks or seeds that may still be out, oldest first.
  std::vector<BundleRecord> open_bundles() const;
  // Returns the bundles that were given up while seeds of them were out. Their tasks may still leave results.
  std::vector<BundleRecord> forgotten_bundles() const;
  bool has(const std::string& name) const;
  // Returns the seeds of a bundle without an outcome, by place.
  std::vector<BundleSeedRecord> seeds_out(std::int64_t bundle) const;
  // Returns the seeds of a point that are out, in all bundles.
  std::vector<int> seeds_out_of_point(std::int64_t point) const;
  std::vector<HandedOver> handed_over() const;
  // Returns the number of seeds of a bundle that came back without a result.
  int without_result(std::int64_t bundle) const;
  int count() const;
  // Returns the folder that was shared last; "" if nothing was ever handed over.
  std::string last_shared() const;
  // True if a bundle in this folder is open.
  bool are_out_in(const std::string& folder) const;

 private:
  std::vector<BundleRecord> bundles_where(const std::string& condition) const;

  Connection& connection_;
};

}  // namespace peclet::runner
