// Adds a step of a realisation on a card to its production window, and ends the realisation if its guard says
// so.
#pragma once

#include "engine/card/card_forces.h"

namespace peclet::engine {

// The work of the solver in a step.
struct CardStepCost {
  int iterations;
  double residual;
};

// `noisy`: the structural Brownian stress is sampled.
template <class Forces, bool noisy>
class CardWindow {
 public:
  // `cell` is that at the end of the step.
  CardWindow(const CardScene& scene, const CardRealisation& own, const CardTeam& team, const Forces& forces,
             const CardCell& cell, CardProgress& at)
      : scene_(scene), own_(own), team_(team), forces_(forces), cell_(cell), at_(at) {}

  // Takes the last step, whose sums are in own.step_sums.
  void take(const CardStepCost& cost) const {
    if (violates_guard()) {
      at_.status = CardStatus::ended;
      return;
    }
    if (at_.step > scene_.equilibration) add(cost);
    if (at_.step == scene_.total) at_.status = CardStatus::ended;
  }

 private:
  static double larger_of(double a, double b) { return a < b ? b : a; }

  bool violates_guard() const {
    return at_.broke_off || !at_.finite ||
           !(at_.displacement <= scene_.largest_displacement * scene_.smallest_radius) ||
           at_.overlap > scene_.largest_overlap;
  }

  void add(const CardStepCost& cost) const {
    const std::uint64_t window = scene_.total - scene_.equilibration,
                        index = at_.step - scene_.equilibration - 1;
    CardBlockSums& block = own_.blocks[index * card_blocks / window];
    team_.each(count_of_card_sums, [&](std::uint32_t k) { block.sum[k] += own_.step_sums[k]; });
    at_.window_overlap = larger_of(at_.window_overlap, at_.overlap);
    at_.iterations += static_cast<std::uint64_t>(cost.iterations);
    at_.sum_of_residuals += cost.residual;
    at_.largest_residual = larger_of(at_.largest_residual, cost.residual);
    at_.divided_steps += at_.division > 0 ? 1 : 0;
    if (at_.deepest_division < at_.division) at_.deepest_division = at_.division;
    const bool samples = index % scene_.sampling == 0;
    if (samples) sample(block);
    team_.once([&] {
      block.steps += 1;
      block.samples += samples ? 1 : 0;
    });
    if (scene_.comparison > 0 && (index + 1) % scene_.comparison == 0) at_.status = CardStatus::compares;
  }

  void sample(CardBlockSums& block) const {
    if constexpr (noisy) {
      const auto structure = forces_.structure(cell_, scene_.shell);
      team_.once([&] {
        for (int c = 0; c < 6; ++c) block.structural[c] += scene_.per_structure * structure.sum[c];
      });
    }
    // Motions relative to the flow, which has the spin -rate / 2 along z.
    const auto energies = team_.template reduce<2, 0>(scene_.particles, [&](std::uint32_t i, auto& sums) {
      const CardSize& size = scene_.sizes[scene_.size_class[i]];
      CardVector u = Forces::vector(own_.velocity[i]), w = Forces::vector(own_.spin[i]);
      u.x -= scene_.rate * own_.position[i].y;
      w.z -= -0.5 * scene_.rate;
      sums.sum[0] += size.mass * dot(u, u).v;
      sums.sum[1] += size.inertia * dot(w, w).v;
    });
    const double degrees = 3 * static_cast<double>(scene_.particles);
    team_.once([&] {
      block.translational += energies.sum[0] / degrees;
      block.rotational += energies.sum[1] / degrees;
    });
  }

  const CardScene& scene_;
  const CardRealisation& own_;
  const CardTeam& team_;
  const Forces& forces_;
  CardCell cell_;
  CardProgress& at_;
};

}  // namespace peclet::engine
