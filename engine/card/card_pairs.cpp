#include "engine/card/card_pairs.h"

#include <algorithm>
#include <limits>

#include "engine/kernels/pair_kinds.h"

namespace peclet::engine {

CardPairs::CardPairs(const Physics& physics, const ParticleState& particles, const NeighbourList& list,
                     const PeriodicCell& box)
    : kinds_(make_pair_kinds(physics, distinct_radii(particles.radius))),
      sizes_(card_sizes(physics, particles)) {
  const std::size_t count = particles.count();
  const Matrix3& edges = box.edges();
  cell_ = {edges.column[0].x, edges.column[1].y, edges.column[2].z, edges.column[1].x};
  scene_.particles = static_cast<std::uint32_t>(count);
  scene_.classes = static_cast<std::uint32_t>(sizes_.size());
  scene_.lubricated = physics.lubrication.has_value();
  scene_.touching = physics.contact.has_value();
  scene_.rate = box.velocity_gradient().column[1].x;
  scene_.size_class = particles.size_class.data();
  scene_.sizes = sizes_.data();
  scene_.kinds = kinds_.data();

  const std::vector<Pair>& pairs = list.pairs();
  own_.room = {static_cast<std::uint32_t>(pairs.size()), 0};
  memory_.resize(share_out(nullptr, count, own_) / sizeof(Bytes));
  share_out(memory_.data()->byte, count, own_);
  progress_.pairs = own_.room.pairs;
  std::ranges::copy(rows_of(particles.position), own_.position);
  std::ranges::copy(rows_of(particles.velocity), own_.velocity);
  std::ranges::copy(rows_of(particles.angular_velocity), own_.spin);

  std::vector<std::vector<CardEnd>> ends(count);
  for (std::uint32_t p = 0; p < own_.room.pairs; ++p) {
    own_.pair[p] = card_pair(pairs[p], list.images()[pairs[p].image]);
    ends[pairs[p].first].push_back({2 * p, pairs[p].second});
    ends[pairs[p].second].push_back({2 * p + 1, pairs[p].first});
  }
  std::uint32_t begin = 0;
  for (std::size_t i = 0; i < count; ++i) {
    own_.end_begin[i] = begin;
    own_.order[i] = static_cast<std::uint32_t>(i);
    std::ranges::copy(ends[i], own_.end + begin);
    begin += static_cast<std::uint32_t>(ends[i].size());
  }
  own_.end_begin[count] = begin;
}

bool CardPairs::has_room_for(const LatticeShift& image) {
  constexpr std::int32_t most = std::numeric_limits<std::int8_t>::max();
  const auto fits = [](std::int32_t k) { return k >= -most && k <= most; };
  return fits(image.x) && fits(image.y) && fits(image.z);
}

void CardPairs::set_springs(const SpringField& springs) {
  for (std::size_t p = 0; p < springs.size(); ++p) {
    const auto values = card_components(springs[p]);
    for (std::size_t c = 0; c < values.size(); ++c) own_.springs[c * own_.room.pairs + p] = values[c];
  }
}

void CardPairs::get_springs_after(SpringField& springs) const {
  for (std::size_t p = 0; p < springs.size(); ++p) {
    const auto value = [&](std::size_t c) { return own_.springs_after[c * own_.room.pairs + p]; };
    springs.set(p, {{value(0), value(1), value(2)}, {value(3), value(4), value(5)}, value(6)});
  }
}

}  // namespace peclet::engine
