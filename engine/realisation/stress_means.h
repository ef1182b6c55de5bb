// The stress and what is measured with it at every step: means in the units of the result, their blocks, and
// the descriptions of all of them.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "contract/json.h"
#include "engine/observables/accumulators.h"
#include "engine/observables/production.h"
#include "engine/scene/scene.h"

namespace peclet::engine {

class StressMeans {
 public:
  explicit StressMeans(const Scene& scene);
  StressMeans(const StressMeans&) = delete;
  StressMeans& operator=(const StressMeans&) = delete;

  // Descriptions of the numbers of means().
  std::vector<Quantity> quantities() const;

  // Returns the means of these sums. Stresses are divided by viscosity * shear_rate, or in the scene's units
  // at rest. `has_jammed`: the flow at a given stress stands still in the end.
  Json means(const System& system, const BlockSums& sums, bool has_jammed = false) const;
  // Returns all blocks in five digits: of numbers, and of xy of every stress that fluctuates, 32; of whole
  // tensors the quarters of the window.
  Json blocks(const System& system, const Production& production) const;

 private:
  // The sums, and what the means need besides.
  struct Measured {
    const BlockSums& sums;
    double volume, volume_fraction, particles;
    bool has_jammed;
    SymmetricTensor total{}, pairs{};
  };
  // A part of the total stress.
  struct Part {
    std::string name, symbol;
    std::function<SymmetricTensor(const Measured&)> mean;
    bool is_constant = false;  // the same in every configuration
    bool is_of_pairs = true;   // or of their motion
  };
  struct Named {
    Quantity quantity;
    std::function<Json(const Measured&)> value;
    bool is_described = true;
  };

  void add_background();
  void add_scalars();
  void add_flow(double stress, bool notices_jams);
  Quantity tensor(const std::string& name, const std::string& symbol) const;

  Physics physics_;
  double unit_;
  std::vector<Part> parts_;  // in the order in which they are added up
  std::vector<Named> others_;
};

}  // namespace peclet::engine
