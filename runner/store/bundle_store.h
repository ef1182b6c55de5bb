// The database's part in handing seeds over: which bundles there are, and which seed is in which.
//
// A seed is handed over while it has a row without an outcome; its state stays `queued` meanwhile, and nobody
// else may run it. The writing functions are for use inside a Transaction of the caller.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "runner/store/sqlite.h"

namespace peclet::runner {

struct BundleSeedRecord {
  int place = 0;  // in the manifest
  int task = 0;
  std::int64_t point = 0;
  int seed = 0;
};

struct BundleRecord {
  std::int64_t id = 0;
  std::string name;    // of the job, too
  std::string shared;  // folder
  std::string job;     // the batch system's number; "": no answer to the submission has been seen
  int tasks = 0;
};

struct HandedOver {  // for people
  std::string bundle, job;
  std::string shared;
  int seeds = 0;  // that are still out
};

class BundleStore {
 public:
  explicit BundleStore(Connection& connection) : connection_(connection) {}

  // A bundle that is about to be submitted.
  std::int64_t prepare(const BundleRecord& bundle, const std::vector<BundleSeedRecord>& seeds);
  void submitted(std::int64_t bundle, const std::string& job);
  void seed_ended(std::int64_t bundle, int place, const char* outcome);
  void close(std::int64_t bundle);
  // Its seeds are nobody's any more, and it is closed; it stays in forgotten_bundles().
  void forget(std::int64_t bundle);

  // Bundles of which tasks or seeds may still be out, by age.
  std::vector<BundleRecord> open_bundles() const;
  // Bundles that were given up while seeds of them were out: their tasks may live and leave results yet.
  std::vector<BundleRecord> forgotten_bundles() const;
  bool has(const std::string& name) const;
  // Seeds of a bundle without an outcome, by place.
  std::vector<BundleSeedRecord> seeds_out(std::int64_t bundle) const;
  // The seeds of a point that are out, in all bundles.
  std::vector<int> seeds_out_of_point(std::int64_t point) const;
  std::vector<HandedOver> handed_over() const;
  // Seeds of a bundle that came back without a result.
  int without_result(std::int64_t bundle) const;
  int count() const;
  // The folder that was shared last; "" when nothing was ever handed over.
  std::string last_shared() const;
  // Seeds are out in this folder.
  bool are_out_in(const std::string& folder) const;

 private:
  std::vector<BundleRecord> bundles_where(const std::string& condition) const;

  Connection& connection_;
};

}  // namespace peclet::runner
