// Suspects are the seeds that were in an engine when it died, and that run in smaller groups until it is
// known which of them does it: see halvings().
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <vector>

#include "runner/statistics/scheduler.h"
#include "runner/store/blame.h"
#include "runner/store/seed_store.h"

namespace peclet::runner {

// The seeds that an engine has, and how many it can have.
struct Company {
  int capacity = 1;
  std::vector<KnownSeed> seeds{};
};

class Suspects {
 public:
  // Forgets all; the next read() reads them from the database again.
  void forget() { halvings_.reset(); }
  void read(SeedStore& seeds);
  bool any() const { return halvings_ && !halvings_->empty(); }
  bool contains(KnownSeed seed) const { return any() && halvings_->contains(seed); }
  // Notes the attempts at a seed of which one has just ended without a result.
  void note(KnownSeed seed, const std::vector<PastAttempt>& attempts);
  void acquit(KnownSeed seed);

  // True if the company may have one more seed, if that is no suspect.
  bool may_grow(const Company& company) const;
  // Returns the suspect that may join the company and of which may_run() is true; of several the one with the
  // most halvings, so that a seed that ends every engine is soon alone.
  std::optional<KnownSeed> next_for(const Company& company,
                                    const std::function<bool(KnownSeed)>& may_run) const;

 private:
  std::optional<std::map<KnownSeed, int>> halvings_;  // of those that have any
};

}  // namespace peclet::runner
