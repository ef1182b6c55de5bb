// Assembles the links of listed pairs, computed like their forces: several pairs of one kind side by side.
#pragma once

#include "engine/kernels/link_kernels.h"
#include "engine/kernels/one_lane.h"
#include "engine/kernels/pair_kernel.h"
#include "engine/kernels/pair_terms.h"

namespace peclet::engine {

namespace {

// Returns the group of the link with this number, among the groups of its level.
PECLET_ALWAYS_INLINE LinkGroup& group_of(LinkGroup* groups, std::uint32_t number) {
  return groups[number / links_side_by_side * groups_side_by_side + number % groups_side_by_side];
}
PECLET_ALWAYS_INLINE int place_of_link(std::uint32_t number) {
  return static_cast<int>(number % links_side_by_side / groups_side_by_side);
}

// Prefetches one line of a level's next groups with each link, so that they are in the cache when they are
// needed. The processor cannot predict them, as groups of many levels are written in turn.
PECLET_ALWAYS_INLINE void fetch_next_groups(LinkGroup* groups, std::uint32_t number) {
  const LinkGroup* const next = groups + std::size_t{number / links_side_by_side + 1} * groups_side_by_side;
  constexpr int for_writing = 1;
  __builtin_prefetch(reinterpret_cast<const char*>(next) + std::size_t{64} * (number % links_side_by_side),
                     for_writing);
}

void couple_nothing(LinkGroup& group, int place, std::uint32_t first, std::uint32_t second) {
  group.first[place] = first;
  group.second[place] = second;
  Floats* const numbers[] = {&group.normal[0],   &group.normal[1],   &group.normal[2],   &group.squeeze,
                             &group.shear,       &group.pump_first,  &group.pump_second, &group.twist_first,
                             &group.twist_cross, &group.twist_second};
  for (Floats* const number : numbers) (*number)[place] = 0;
}

// Fills up the last groups of a level with links that couple nothing.
void fill_up(LinkLevel& level, std::uint32_t links, LinkGroup* groups) {
  const std::uint32_t rest = links % links_side_by_side;
  level.count_of_groups = links / links_side_by_side * groups_side_by_side +
                          (rest < groups_side_by_side ? rest : groups_side_by_side);
  const std::uint32_t row = level.rows_begin;
  for (; links % links_side_by_side != 0; ++links) {
    couple_nothing(group_of(groups + level.groups_begin, links), place_of_link(links), row, row);
  }
  for (std::uint32_t k = level.count_of_crossing; k % links_per_group != 0; ++k) {
    couple_nothing(groups[level.crossing_begin + k / links_per_group], static_cast<int>(k % links_per_group),
                   row, row);
  }
}

}  // namespace

// Up to width_of<Real> pairs of one run.
template <class Real>
class LinkedPairs {
 public:
  PECLET_ALWAYS_INLINE LinkedPairs(const PairKernelInput& in, const PairRun& run, std::uint32_t begin,
                                   int count)
      : in_(in), run_(run), kind_(in.kinds[run.kind]), begin_(begin), count_(count) {
    for (int k = 0; k < width_of<Real>; ++k) {
      const Pair& pair = in.pairs[begin + static_cast<std::uint32_t>(k < count ? k : 0)];
      first_[k] = pair.first;
      second_[k] = pair.second;
      image_[k] = pair.image;
    }
    Vector3Of<Real> r = gather_rows(in.position, second_, Real{}) - gather_rows(in.position, first_, Real{});
    motion_.velocity = gather_rows(in.velocity, second_, Real{}) - gather_rows(in.velocity, first_, Real{});
    if (run.imaged) {
      r += gather_rows(in.image_displacement, image_, Real{});
      motion_.velocity += gather_rows(in.image_velocity, image_, Real{});
    }
    motion_.spin_first = gather_rows(in.spin, first_, Real{});
    motion_.spin_second = gather_rows(in.spin, second_, Real{});
    const Real squared = dot(r, r);
    const double range = kind_.range + kind_reach(in.parameters, kind_);
    const auto near = listed_lanes(count, Real{}) & (squared <= Real{range * range});
    near_ = bits(near);
    not_finite_ = bits(listed_lanes(count, Real{}) & !(squared < Real{__builtin_inf()}));
    // Lanes out of range compute with a distance at which every term is zero.
    shape_ = {where(near, r), {}, select(near, square_root(squared), Real{2 * range}), kind_.sum_of_radii};
    shape_.normal = (1.0 / shape_.distance) * shape_.separation;
    ahead_ = shape_;
    ahead_.distance += in.parameters.approach_time * dot(motion_.velocity, shape_.normal);
  }

  unsigned near() const { return near_; }
  unsigned not_finite() const { return not_finite_; }

  // Returns the derivative of the lubrication load by the motion, as a resistance. Requires lubrication.
  PECLET_ALWAYS_INLINE PairResistanceOf<Real> resistance() const {
    return tangent_resistance(kind_.resistance, in_.parameters.step_resistance, kind_.gap,
                              kind_.lubrication_range, shape_, dot(motion_.velocity, shape_.normal));
  }

  PECLET_ALWAYS_INLINE PairResistanceOf<Real> coupling(const Terms& terms, const LinkWeights& weights,
                                                       const PairResistanceOf<Real>& resistance) const {
    const PairParameters& parameters = in_.parameters;
    PairResistanceOf<Real> sum = scaled(Real{weights.timestep}, resistance);
    add_stiffness(sum, terms, parameters.contact, kind_, ahead_,
                  {.resistance = weights.timestep,
                   .normal = weights.timestep * weights.normal_time,
                   .tangential = weights.timestep * weights.timestep * parameters.felt_share},
                  [&]() PECLET_INLINE_LAMBDA { return held_springs(terms); });
    return sum;
  }

  // Adds the loads of the pairs to the rows of their particles, and their stress to `sums`. `resistance` is
  // that of lubrication.
  PECLET_ALWAYS_INLINE void leave(const Terms& terms, const PairResistanceOf<Real>& resistance,
                                  const PairKernelOutput& out, LaneSumsOf<Real>& sums) const {
    PairLoadOf<Real> load = lubrication_load(resistance, shape_, motion_);
    sums.add_stress(StressTerm::lubrication, shape_, load.force);
    if (terms.conservative) {
      for_each_conservative_law(
          [&](StressTerm part, const auto& law) PECLET_INLINE_LAMBDA {
            const auto within = ahead_.distance < law.range;
            if (!(law.range > 0) || !any(within)) return;
            const Vector3Of<Real> force = where(within, conservative_force(law, ahead_));
            sums.add_stress(part, shape_, force);
            load.force += force;
          },
          kind_.conservative);
    }
    if (terms.contact && sums.count_contacts(kind_, ahead_.overlap())) {
      const Vector3Of<Real> force = where(
          ahead_.overlap() > 0.0, contact_normal_force(in_.parameters.contact.normal_stiffness, ahead_));
      sums.add_stress(StressTerm::contact_normal, shape_, force);
      load.force += force;
    }
    leave(load, out);
  }

  // Adds the loads that a change of the motion adds, by the coefficients of coupling() over the timestep.
  PECLET_ALWAYS_INLINE void leave_change(const Terms& terms, const LinkWeights& weights,
                                         const ChangeRows& change, const PairKernelOutput& out,
                                         LaneSumsOf<Real>& sums) const {
    const PairMotionOf<Real> motion = {
        gather_rows(change.velocity, second_, Real{}) - gather_rows(change.velocity, first_, Real{}),
        gather_rows(change.spin, first_, Real{}), gather_rows(change.spin, second_, Real{})};
    const PairParameters& parameters = in_.parameters;
    const Real approach = weights.normal_time * dot(motion.velocity, shape_.normal);
    PairLoadOf<Real> load{};
    if (terms.lubrication) {
      load = lubrication_load(resistance(), shape_, motion);
      sums.add_stress(StressTerm::lubrication, shape_, load.force);
    }
    const auto push = [&](StressTerm term, const Vector3Of<Real>& force) PECLET_INLINE_LAMBDA {
      sums.add_stress(term, shape_, force);
      load.force += force;
    };
    if (terms.conservative) {
      const auto stiff = positive_stiffness(kind_.conservative, ahead_, 1) > 0.0;
      for_each_conservative_law(
          [&](StressTerm part, const auto& law) PECLET_INLINE_LAMBDA {
            const auto acts = stiff & (ahead_.distance < law.range);
            if (!(law.range > 0) || !any(acts)) return;
            const Real stiffness = law.stiffness(ahead_.surface_distance());
            push(part, where(acts, (stiffness * approach) * shape_.normal));
          },
          kind_.conservative);
    }
    const auto touching = ahead_.overlap() > 0.0;
    if (terms.contact && any(touching)) {
      push(StressTerm::contact_normal,
           where(touching, (parameters.contact.normal_stiffness * approach) * shape_.normal));
      push(StressTerm::contact_damping,
           where(touching, contact_damping_force(parameters.contact.normal_damping, shape_, motion)));
      if (terms.friction) {
        PairResistanceOf<Real> springs{};
        add_springs(springs, terms, contact_of(parameters.contact, kind_, ahead_),
                    {.resistance = 1, .tangential = weights.timestep * parameters.felt_share},
                    held_springs(terms));
        const PairLoadOf<Real> stretched = lubrication_load(springs, shape_, motion);
        load.torque_first += stretched.torque_first;
        load.torque_second += stretched.torque_second;
        push(StressTerm::friction, stretched.force);
      }
    }
    leave(load, out);
  }

  // Writes the links of pairs within a block.
  PECLET_ALWAYS_INLINE void emit(const LinkPlaces& places, LinkGroup* groups,
                                 const PairResistanceOf<Real>& coupling) const {
    // Pairs within reach that leave the range in this step have no coupling.
    const unsigned coupled = near_ & (bits(coupling.squeeze > 0.0) | bits(coupling.shear > 0.0));
    const LinkNumbers numbers(shape_.normal, coupling);
    for (int k = 0; k < count_; ++k) {
      if ((coupled >> k & 1U) == 0) continue;
      const std::uint32_t row_of_first = places.row[first_[k]], row_of_second = places.row[second_[k]];
      const bool swapped = row_of_first < row_of_second;
      const std::uint32_t later = swapped ? row_of_second : row_of_first;
      const std::uint32_t level = places.level[later];
      const std::uint32_t number = places.next[level]++;
      fetch_next_groups(groups + places.levels[level].groups_begin, number);
      LinkGroup& group = group_of(groups + places.levels[level].groups_begin, number);
      const int place = place_of_link(number);
      group.first[place] = later;
      group.second[place] = swapped ? row_of_first : row_of_second;
      put(group, place, numbers, k, swapped);
    }
  }

  // Writes the links of crossing pairs to their places `crossing`.
  PECLET_ALWAYS_INLINE void emit_crossing(const CrossingLink* crossing, const std::uint32_t* row,
                                          LinkGroup* groups, const PairResistanceOf<Real>& coupling) const {
    const LinkNumbers numbers(shape_.normal, coupling);
    for (int k = 0; k < count_; ++k) {
      const CrossingLink& link = crossing[k];
      LinkGroup& group = groups[link.place / links_per_group];
      const int place = static_cast<int>(link.place % links_per_group);
      if (is_near(k)) {
        group.first[place] = link.first;
        group.second[place] = link.second;
        put(group, place, numbers, k, link.first != row[first_[k]]);
      } else {
        couple_nothing(group, place, link.first, link.second);
      }
    }
  }

 private:
  PECLET_ALWAYS_INLINE void leave(const PairLoadOf<Real>& load, const PairKernelOutput& out) const {
    if (run_.first_is_away) {
      leave_load<true>(load, run_, begin_, count_, first_, second_, out);
    } else {
      leave_load<false>(load, run_, begin_, count_, first_, second_, out);
    }
  }

  bool is_near(int k) const { return (near_ >> k & 1U) != 0; }

  // The numbers of the links of the pairs, in single precision.
  struct LinkNumbers {
    PECLET_ALWAYS_INLINE LinkNumbers(const Vector3Of<Real>& n, const PairResistanceOf<Real>& coupling) {
      store_floats(normal[0], n.x);
      store_floats(normal[1], n.y);
      store_floats(normal[2], n.z);
      store_floats(squeeze, coupling.squeeze);
      store_floats(shear, coupling.shear);
      store_floats(pump[0], coupling.pump_first);
      store_floats(pump[1], coupling.pump_second);
      store_floats(twist[0], coupling.twist_first);
      store_floats(twist[1], coupling.twist_second);
      store_floats(twist_cross, coupling.twist_cross);
    }

    using Each = float[width_of<Real>];
    Each normal[3], squeeze, shear, pump[2], twist[2], twist_cross;  // pump and twist: of first and second
  };

  // Writes link k to a place of a group. `swapped`: its first particle is the second one of the pair.
  PECLET_ALWAYS_INLINE static void put(LinkGroup& group, int place, const LinkNumbers& numbers, int k,
                                       bool swapped) {
    const int first = swapped ? 1 : 0, second = 1 - first;
    const float sign = swapped ? -1.0F : 1.0F;
    for (int c = 0; c < 3; ++c) group.normal[c][place] = sign * numbers.normal[c][k];
    group.squeeze[place] = numbers.squeeze[k];
    group.shear[place] = numbers.shear[k];
    group.pump_first[place] = numbers.pump[first][k];
    group.pump_second[place] = numbers.pump[second][k];
    group.twist_first[place] = numbers.twist[first][k];
    group.twist_cross[place] = numbers.twist_cross[k];
    group.twist_second[place] = numbers.twist[second][k];
  }

  PECLET_ALWAYS_INLINE OfEachSpring<Real> held_springs(const Terms& terms) const {
    const PairParameters& parameters = in_.parameters;
    return held_shares(terms, contact_of(parameters.contact, kind_, ahead_), motion_,
                       parameters.spring_timestep * parameters.felt_share,
                       springs_at<Real>(in_, terms, begin_, count_));
  }

  PairGeometryOf<Real> shape_, ahead_;
  PairMotionOf<Real> motion_;
  std::uint32_t first_[width_of<Real>], second_[width_of<Real>], image_[width_of<Real>];
  const PairKernelInput& in_;
  const PairRun& run_;
  const PairKind& kind_;
  std::uint32_t begin_;
  int count_;
  unsigned near_, not_finite_;
};

template <class Real, bool with_loads>
void assemble(const PairKernelInput& in, const PairRun* runs, std::size_t count, const Terms& terms,
              const LinkWeights& weights, const LinkPlaces& places, const LinkBlock& block, LinkGroup* groups,
              const PairKernelOutput* loads) {
  constexpr std::uint32_t width = width_of<Real>;
  for (std::uint32_t level = block.levels_begin; level < block.levels_end; ++level) places.next[level] = 0;
  LaneSumsOf<Real> sums;
  for (const PairRun* run = runs; run < runs + count; ++run) {
    for (std::uint32_t begin = run->begin; begin < run->end; begin += width) {
      const std::uint32_t rest = run->end - begin;
      const LinkedPairs<Real> pairs(in, *run, begin, static_cast<int>(rest < width ? rest : width));
      const bool crosses = run->crossing != within_block;
      if constexpr (with_loads) sums.not_finite |= pairs.not_finite();
      if (pairs.near() == 0 && !crosses) continue;
      const PairResistanceOf<Real> resistance =
          terms.lubrication ? pairs.resistance() : PairResistanceOf<Real>{};
      if constexpr (with_loads) pairs.leave(terms, resistance, *loads, sums);
      const PairResistanceOf<Real> coupling = pairs.coupling(terms, weights, resistance);
      if (crosses) {
        pairs.emit_crossing(places.crossing + run->crossing + (begin - run->begin), places.row, groups,
                            coupling);
      } else {
        pairs.emit(places, groups, coupling);
      }
    }
  }
  for (std::uint32_t level = block.levels_begin; level < block.levels_end; ++level) {
    fill_up(places.levels[level], places.next[level], groups);
  }
  if constexpr (with_loads) sums.store(*loads->sums);
}

template <class Real>
void leave_change(const PairKernelInput& in, const PairRun* runs, std::size_t count, const Terms& terms,
                  const LinkWeights& weights, const ChangeRows& change, const PairKernelOutput& loads) {
  constexpr std::uint32_t width = width_of<Real>;
  LaneSumsOf<Real> sums;
  for (const PairRun* run = runs; run < runs + count; ++run) {
    for (std::uint32_t begin = run->begin; begin < run->end; begin += width) {
      const std::uint32_t rest = run->end - begin;
      const LinkedPairs<Real> pairs(in, *run, begin, static_cast<int>(rest < width ? rest : width));
      // The rows of crossing pairs are written every time: nothing else clears them.
      if (pairs.near() == 0 && run->crossing == within_block) continue;
      pairs.leave_change(terms, weights, change, loads, sums);
    }
  }
  sums.store(*loads.sums);
}

template <class Real>
void assemble_links(const PairKernelInput& in, const PairRun* runs, std::size_t count, const Terms& terms,
                    const LinkWeights& weights, const LinkPlaces& places, const LinkBlock& block,
                    LinkGroup* groups, const PairKernelOutput* loads) {
  const auto chosen = loads != nullptr ? &assemble<Real, true> : &assemble<Real, false>;
  chosen(in, runs, count, terms, weights, places, block, groups, loads);
}

}  // namespace peclet::engine
