// Keeps the springs of touching pairs when the neighbour list is rebuilt.
#pragma once

#include <array>
#include <vector>

#include "engine/state/neighbour_list.h"

namespace peclet::engine {

// The tangential and the rolling spring of a pair; both are zero without contact.
struct ContactSprings {
  Vector3 tangential, rolling;
  double slides = 0;  // 1 if the contact slides, else 0; used by kinds that remember sliding
};

// The springs that a scene needs, and whether contacts remember that they slide, as bits.
enum class SpringKinds : std::uint8_t {
  none = 0,
  tangential = 1,
  tangential_and_rolling = 3,
  tangential_that_slide = 5,
  tangential_and_rolling_that_slide = 7
};
constexpr bool include(SpringKinds all, SpringKinds part) {
  return (static_cast<unsigned>(all) & static_cast<unsigned>(part)) == static_cast<unsigned>(part);
}
constexpr bool remember_sliding(SpringKinds kinds) {
  return include(kinds, SpringKinds::tangential_that_slide);
}
constexpr SpringKinds that_slide(SpringKinds kinds) {
  return include(kinds, SpringKinds::tangential_and_rolling) ? SpringKinds::tangential_and_rolling_that_slide
                                                             : SpringKinds::tangential_that_slide;
}
// Returns the number of components of the springs, three each.
constexpr std::size_t components_of_springs(SpringKinds kinds) {
  return kinds == SpringKinds::none ? 0 : include(kinds, SpringKinds::tangential_and_rolling) ? 6 : 3;
}

// The springs of all pairs of a list, stored component by component.
class SpringField {
 public:
  SpringField() = default;
  SpringField(SpringKinds kinds, std::size_t pairs) : kinds_(kinds), pairs_(pairs) {
    for (std::size_t c = 0; c < components(); ++c) component_[c].assign(pairs, 0.0);
  }

  SpringKinds kinds() const { return kinds_; }
  std::size_t size() const { return pairs_; }
  ContactSprings operator[](std::size_t pair) const {
    ContactSprings springs;
    if (kinds_ != SpringKinds::none) {
      springs.tangential = {component_[0][pair], component_[1][pair], component_[2][pair]};
    }
    if (include(kinds_, SpringKinds::tangential_and_rolling)) {
      springs.rolling = {component_[3][pair], component_[4][pair], component_[5][pair]};
    }
    if (remembers_sliding()) springs.slides = component_[components() - 1][pair];
    return springs;
  }
  // Ignores springs of kinds that the field does not have.
  void set(std::size_t pair, const ContactSprings& springs) {
    const std::array<double, 6> values = {springs.tangential.x, springs.tangential.y, springs.tangential.z,
                                          springs.rolling.x,    springs.rolling.y,    springs.rolling.z};
    for (std::size_t c = 0; c < components_of_springs(kinds_); ++c) component_[c][pair] = values[c];
    if (remembers_sliding()) component_[components() - 1][pair] = springs.slides;
  }
  bool remembers_sliding() const { return remember_sliding(kinds_); }

  // Returns how many components the kinds have, in this order: tangential x, y, z; rolling x, y, z; slides.
  std::size_t components() const { return components_of_springs(kinds_) + (remembers_sliding() ? 1 : 0); }
  double* component(std::size_t c) { return component_[c].data(); }
  const std::vector<double>& values(std::size_t c) const { return component_[c]; }
  void set_values(std::size_t c, std::vector<double> values) { component_[c] = std::move(values); }

 private:
  SpringKinds kinds_ = SpringKinds::none;
  std::size_t pairs_ = 0;
  std::array<std::vector<double>, 7> component_;
};

// The springs of one contact, identified independently of the list: by the ids of its two particles and the
// shift between their unwrapped positions, which wrapping does not change.
struct HeldContact {
  std::uint32_t first, second;
  LatticeShift image;
  ContactSprings springs;
};

// Sorts contacts by first id, second id and image.
void sort_contacts(std::vector<HeldContact>& contacts);

// Returns the contacts that have a spring other than zero or slide, sorted.
std::vector<HeldContact> held_contacts(const NeighbourList& list, const ParticleState& particles,
                                       const SpringField& springs, int threads = 1);

// Returns the springs of each pair of a new list from the sorted contacts `held`. The image counters of
// `particles` must be in the same basis as `held`. Contacts that are no longer listed have opened; their
// springs are dropped.
SpringField placed_contacts(const NeighbourList& list, const ParticleState& particles,
                            const std::vector<HeldContact>& held, SpringKinds kinds, int threads = 1);

}  // namespace peclet::engine
