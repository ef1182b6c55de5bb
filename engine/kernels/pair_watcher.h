// Who looks at the single pairs of a step.
#pragma once

#include <vector>

#include "engine/kernels/pairs/pair_sums.h"
#include "engine/state/system.h"

namespace peclet::engine {

class PairWatcher {
 public:
  virtual ~PairWatcher() = default;

  // Of a step, or of a part of it with this weight, whose parts follow each other: where the spheres are and
  // how fast when their forces act.
  virtual void begin(const System& system, double weight) = 0;
  // One of its pairs: its part of the stress, times the volume, and the force on its first sphere, noise
  // included. Of the system of begin().
  virtual void take(const System& system, const Pair& pair, const PairSums& sums, const Vector3& force) = 0;
  // With noise, the part of a particle in the stress of the motion, times the volume.
  virtual void take_motion(const System& system, std::size_t particle, const SymmetricTensor& stress) = 0;
};

// Several of them, as one.
class PairWatchers final : public PairWatcher {
 public:
  void clear() { all_.clear(); }
  bool empty() const { return all_.empty(); }
  // Nothing of null.
  void add(PairWatcher* watcher) {
    if (watcher != nullptr) all_.push_back(watcher);
  }

  void begin(const System& system, double weight) override {
    for (PairWatcher* const watcher : all_) watcher->begin(system, weight);
  }
  void take(const System& system, const Pair& pair, const PairSums& sums, const Vector3& force) override {
    for (PairWatcher* const watcher : all_) watcher->take(system, pair, sums, force);
  }
  void take_motion(const System& system, std::size_t particle, const SymmetricTensor& stress) override {
    for (PairWatcher* const watcher : all_) watcher->take_motion(system, particle, stress);
  }

 private:
  std::vector<PairWatcher*> all_;
};

}  // namespace peclet::engine
