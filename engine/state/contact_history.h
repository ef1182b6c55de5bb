// Springs of touching pairs, and how they survive a rebuild of the neighbour list.
#pragma once

#include <array>
#include <vector>

#include "engine/state/neighbour_list.h"

namespace peclet::engine {

// Tangential and rolling spring of a pair; zero without contact.
struct ContactSprings {
  Vector3 tangential, rolling;
  double slides = 0;  // 1: the contact slides; of kinds that remember it
};

// Which springs a scene needs, and whether contacts remember that they slide; the others take no memory. Each
// has a bit.
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
// Three of each spring.
constexpr std::size_t components_of_springs(SpringKinds kinds) {
  return kinds == SpringKinds::none ? 0 : include(kinds, SpringKinds::tangential_and_rolling) ? 6 : 3;
}

// The springs of each pair of a list, component by component.
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
  // Springs of a kind that the field does not have are dropped.
  void set(std::size_t pair, const ContactSprings& springs) {
    const std::array<double, 6> values = {springs.tangential.x, springs.tangential.y, springs.tangential.z,
                                          springs.rolling.x,    springs.rolling.y,    springs.rolling.z};
    for (std::size_t c = 0; c < components_of_springs(kinds_); ++c) component_[c][pair] = values[c];
    if (remembers_sliding()) component_[components() - 1][pair] = springs.slides;
  }
  bool remembers_sliding() const { return remember_sliding(kinds_); }

  // Tangential x, y, z, rolling x, y, z, slides; as many as the kinds have.
  std::size_t components() const { return components_of_springs(kinds_) + (remembers_sliding() ? 1 : 0); }
  double* component(std::size_t c) { return component_[c].data(); }
  const std::vector<double>& values(std::size_t c) const { return component_[c]; }
  void set_values(std::size_t c, std::vector<double> values) { component_[c] = std::move(values); }

 private:
  SpringKinds kinds_ = SpringKinds::none;
  std::size_t pairs_ = 0;
  std::array<std::vector<double>, 7> component_;
};

// The springs of one contact under a name that outlives the list: the ids of the two particles and the shift
// between their unwrapped places, which wrapping does not change.
struct HeldContact {
  std::uint32_t first, second;
  LatticeShift image;
  ContactSprings springs;
};

// Into the order of first id, second id and image.
void sort_contacts(std::vector<HeldContact>& contacts);

// All springs that are not zero or slide, sorted.
std::vector<HeldContact> held_contacts(const NeighbourList& list, const ParticleState& particles,
                                       const SpringField& springs, int threads = 1);

// Springs of each pair of a new list. The image counters of `particles` are as they are now, in the same
// basis as `held`, which is sorted. A contact that is not listed any more has opened: its springs are
// forgotten.
SpringField placed_contacts(const NeighbourList& list, const ParticleState& particles,
                            const std::vector<HeldContact>& held, SpringKinds kinds, int threads = 1);

}  // namespace peclet::engine
