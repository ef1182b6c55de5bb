#include "engine/state/contact_history.h"

#include <algorithm>
#include <mutex>
#include <tuple>

#include "engine/state/threads.h"

namespace peclet::engine {
namespace {

bool is_zero(const Vector3& v) { return v.x == 0 && v.y == 0 && v.z == 0; }

auto name_of(const HeldContact& contact) {
  return std::make_tuple(contact.first, contact.second, contact.image);
}

// Returns the contact of a listed pair, without springs.
HeldContact contact_of(const NeighbourList& list, const ParticleState& particles, const Pair& pair) {
  return {particles.id[pair.first],
          particles.id[pair.second],
          list.images()[pair.image] - particles.image[pair.second] + particles.image[pair.first],
          {}};
}

}  // namespace

void sort_contacts(std::vector<HeldContact>& contacts) {
  std::sort(contacts.begin(), contacts.end(),
            [](const HeldContact& a, const HeldContact& b) { return name_of(a) < name_of(b); });
}

std::vector<HeldContact> held_contacts(const NeighbourList& list, const ParticleState& particles,
                                       const SpringField& springs, int threads) {
  std::vector<HeldContact> held;
  if (springs.kinds() == SpringKinds::none) return held;
  std::mutex of_held;
  for_each_range(springs.size(), threads, [&](std::size_t begin, std::size_t end) {
    std::vector<HeldContact> part;
    for (std::size_t p = begin; p < end; ++p) {
      const ContactSprings of_pair = springs[p];
      if (is_zero(of_pair.tangential) && is_zero(of_pair.rolling) && of_pair.slides == 0) continue;
      part.push_back(contact_of(list, particles, list.pairs()[p]));
      part.back().springs = of_pair;
    }
    const std::lock_guard lock(of_held);
    held.insert(held.end(), part.begin(), part.end());
  });
  sort_contacts(held);  // threads add their parts in any order
  return held;
}

SpringField placed_contacts(const NeighbourList& list, const ParticleState& particles,
                            const std::vector<HeldContact>& held, SpringKinds kinds, int threads) {
  SpringField springs(kinds, list.pairs().size());
  if (held.empty()) return springs;
  // The index in `held` of the first contact of each first particle.
  std::vector<std::uint32_t> begin(particles.count() + 1);
  for (const HeldContact& contact : held) ++begin[contact.first + 1];
  for (std::size_t i = 0; i < particles.count(); ++i) begin[i + 1] += begin[i];
  for_each_index(list.pairs().size(), threads, [&](std::size_t p) {
    const std::uint32_t id = particles.id[list.pairs()[p].first];
    if (begin[id] == begin[id + 1]) return;
    const auto wanted = name_of(contact_of(list, particles, list.pairs()[p]));
    for (std::uint32_t k = begin[id]; k < begin[id + 1]; ++k) {
      if (name_of(held[k]) == wanted) springs.set(p, held[k].springs);
    }
  });
  return springs;
}

}  // namespace peclet::engine
