// The variants of the program for cards. Each is compiled and loaded by itself: a scene needs one of them,
// and the driver would compile all that it loads.
#pragma once

#include "engine/card/card_steps.h"

namespace peclet::engine {

// A realisation and its scene.
struct CardSlot {
  const CardScene* scene;
  CardRealisation realisation;
};

struct CardVariant {
  enum class Springs : unsigned { none, sliding, sliding_and_rolling };
  Springs springs;
  bool strained, noisy;

  constexpr unsigned number() const {
    return 4 * static_cast<unsigned>(springs) + (strained ? 2 : 0) + (noisy ? 1 : 0);
  }
  // Returns the terms that are compiled. Laws that a scene lacks have zero parameters; springs slide with the
  // friction that they stick with if a scene has no kinetic friction.
  constexpr Terms terms() const {
    const bool friction = springs != Springs::none;
    return {.lubrication = true,
            .strained = strained,
            .contact = true,
            .damping = true,
            .friction = friction,
            .rolling = springs == Springs::sliding_and_rolling,
            .conservative = true,
            .kinetic = friction};
  }
};
constexpr unsigned count_of_card_variants = 12;
constexpr CardVariant card_variant(unsigned number) {
  return {static_cast<CardVariant::Springs>(number / 4), number % 4 >= 2, number % 2 == 1};
}

// The memory of a team near the processor: copies of what all members read, and sums.
struct CardNear {
  CardScene scene;
  CardRealisation own;
  double part_sums[count_of_card_sums];
};

// `scaled` is room for a motion of each particle, and for the inverse own blocks behind them if bounds say
// so.
template <unsigned number>
PECLET_ALWAYS_INLINE void advance_slot(const CardSlot& slot, CardNear& near, CardMotion* scaled,
                                       const CardTeam& team, const CardBounds& bounds) {
  constexpr CardVariant variant = card_variant(number);
  team.once([&] {
    near.scene = *slot.scene;
    near.own = slot.realisation;
    near.own.part_sums = near.part_sums;
    near.own.scaled = scaled;
    if (bounds.has_near_blocks) near.own.inverse = reinterpret_cast<float*>(scaled + near.scene.particles);
  });
  CardSteps<variant.terms(), variant.noisy>(near.scene, near.own, team).run(bounds);
}

}  // namespace peclet::engine
