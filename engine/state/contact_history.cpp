#include "engine/state/contact_history.h"

#include <algorithm>
#include <tuple>

namespace peclet::engine {
namespace {

bool is_zero(const Vector3& v) { return v.x == 0 && v.y == 0 && v.z == 0; }

}  // namespace

std::vector<HeldContact> held_contacts(const NeighbourList& list, const std::vector<LatticeShift>& wrapped,
                                       const std::vector<ContactSprings>& springs) {
  std::vector<HeldContact> held;
  for (std::size_t p = 0; p < springs.size(); ++p) {
    if (is_zero(springs[p].tangential) && is_zero(springs[p].rolling)) {
      continue;
    }
    const Pair& pair = list.pairs()[p];
    const LatticeShift image = list.images()[pair.image] - wrapped[pair.second] + wrapped[pair.first];
    held.push_back({pair.first, pair.second, image, springs[p]});
  }
  return held;
}

std::vector<ContactSprings> placed_contacts(const NeighbourList& list,
                                            const std::vector<LatticeShift>& wrapped,
                                            const std::vector<HeldContact>& held) {
  std::vector<ContactSprings> springs(list.pairs().size());
  for (const HeldContact& contact : held) {
    const LatticeShift image = contact.image + wrapped[contact.second] - wrapped[contact.first];
    const auto wanted = std::make_tuple(contact.first, contact.second, image);
    const auto pair = std::lower_bound(
        list.pairs().begin(), list.pairs().end(), wanted, [&list](const Pair& candidate, const auto& key) {
          return std::make_tuple(candidate.first, candidate.second, list.images()[candidate.image]) < key;
        });
    if (pair != list.pairs().end() && pair->first == contact.first && pair->second == contact.second &&
        list.images()[pair->image] == image) {
      springs[static_cast<std::size_t>(pair - list.pairs().begin())] = contact.springs;
    }
  }
  return springs;
}

}  // namespace peclet::engine
