// Computes and describes the means of stress, contacts and temperatures, in the units of the result.
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

  std::vector<Quantity> quantities() const;

  // Returns the means of these sums. Stresses are in units of viscosity * shear_rate, or of the scene at
  // rest. `has_jammed`: the suspension has jammed at a given stress.
  Json means(const System& system, const BlockSums& sums, bool has_jammed = false) const;
  // Returns block means in five digits: 32 of scalars and of xy of fluctuating stresses, quarters of tensors.
  Json blocks(const System& system, const Production& production) const;

 private:
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
    bool is_constant = false;  // in all configurations
    bool is_of_pairs = true;   // from pairs, or from the motion of particles
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
  std::vector<Part> parts_;  // in the order of summation
  std::vector<Named> others_;
};

}  // namespace peclet::engine
