// Prepares memory of slots and numbers of scenes for kernels for cards.
#pragma once

#include <array>
#include <vector>

#include "engine/card/card_variants.h"
#include "engine/scene/scene.h"
#include "engine/state/contact_history.h"

namespace peclet::engine {

// Shares out a piece of memory: parts in turn, each aligned for the widest accesses.
class CardParts {
 public:
  explicit CardParts(std::byte* begin) : begin_(begin) {}

  template <class T>
  void take(T*& part, std::size_t count) {
    constexpr std::size_t alignment = 256;
    part = reinterpret_cast<T*>(begin_ + used_);
    used_ += (count * sizeof(T) + alignment - 1) / alignment * alignment;
  }
  std::size_t used() const { return used_; }

 private:
  std::byte* begin_;
  std::size_t used_ = 0;
};

// Sets all pointers but that of the progress, for `own.room`. Returns the bytes that they need.
std::size_t share_out(std::byte* memory, std::size_t particles, CardRealisation& own);

std::vector<CardRow> rows_of(const VectorField& field);
CardPair card_pair(const Pair& pair, const LatticeShift& image);
std::array<double, components_of_card_springs> card_components(const ContactSprings& springs);

// Returns the size classes.
std::vector<CardSize> card_sizes(const Physics& physics, const ParticleState& particles);

CardVariant card_variant_of(const Physics& physics);

// Returns pair_parameters() as kernels for cards need them.
PairParameters card_parameters(const Physics& physics, double timestep);

// Returns the parameters of steps of this size (NoisyMidpoint, Midpoint).
CardLevel card_level(const Physics& physics, const ParticleState& particles, double timestep);

}  // namespace peclet::engine
