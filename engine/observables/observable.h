// What a scene asks for besides the stress: sampled during the production window.
#pragma once

#include <cstdint>
#include <vector>

#include "contract/json.h"
#include "engine/gsd/frames.h"
#include "engine/kernels/momentum_flux.h"
#include "engine/kernels/pair_watcher.h"
#include "engine/state/system.h"

namespace peclet::engine {

class Observable {
 public:
  // Steps between samples, of which the first is at the first step of the window.
  explicit Observable(std::uint64_t interval) : interval_(interval) {}
  virtual ~Observable() = default;

  std::uint64_t interval() const { return interval_; }
  // Whether it takes the flux of momentum, and what it does with that of every step of the window.
  virtual bool takes_flux() const { return false; }
  virtual void take_flux(const MomentumFlux& /*flux*/) {}
  // Who looks at the pairs of each step that is sampled, before the sample. Null: nobody.
  virtual PairWatcher* watcher() { return nullptr; }
  // Requires a complete step (integrator.h) and the system that every other sample is of. `block` counts the
  // 32 blocks of the window from 0.
  virtual void sample(const System& system, std::size_t block) = 0;
  // Adds the values of its quantities to the result's means, at the paths that their names are. Requires a
  // sample.
  virtual void add_to(Json& mean) const = 0;
  // The same of the blocks that it keeps. A function of lags up to the whole window has none.
  virtual void add_blocks_to(Json& blocks) const = 0;

  // What it writes beside the result; null: nothing.
  virtual gsd::Frames* frames() { return nullptr; }

  // Everything that samples have left, bit by bit.
  virtual void save(ArchiveWriter& archive) const = 0;
  virtual void load(ArchiveReader& archive) = 0;

 private:
  std::uint64_t interval_;
};

// Samples in a window of so many steps, one at least.
constexpr std::uint64_t samples_in(std::uint64_t steps, std::uint64_t interval) {
  return (steps - 1) / interval + 1;
}

}  // namespace peclet::engine
