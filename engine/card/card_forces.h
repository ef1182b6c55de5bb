// The forces of pairs on a card, and the links of the linear system: one pair for each turn of a loop, then
// the sums of each row over its pairs. The formulas are those of engine/terms.
#pragma once

#include <Random123/threefry.h>

#include "engine/card/card_list.h"
#include "engine/card/card_number.h"
#include "engine/card/card_solver.h"
#include "engine/kernels/pair_terms.h"
#include "engine/terms/fill_normals.h"
#include "engine/terms/keyed_random.h"

namespace peclet::engine {

// The stresses that a pass over pairs sums: those of the terms, in their order, and three numbers.
template <Terms terms>
struct CardStresses {
  static constexpr bool has(std::size_t term) { return terms.*stress_parts[term].of; }
  static constexpr int count() {
    int number = 0;
    for (std::size_t t = 0; t < count_of_stress_terms; ++t) number += has(t) ? 1 : 0;
    return number;
  }
  static constexpr int place(std::size_t term) {
    int number = 0;
    for (std::size_t t = 0; t < term; ++t) number += has(t) ? 1 : 0;
    return 6 * number;
  }
  static constexpr int contacts = 6 * count(), overlaps = contacts + 1, not_finite = contacts + 2;
  static constexpr int numbers = contacts + 3;
};

template <Terms terms>
class CardForces {
 public:
  static constexpr Terms noise_terms = {.lubrication = true, .noise = true, .strained = terms.strained};

  CardForces(const CardScene& scene, const CardRealisation& own, const CardProgress& at, const CardTeam& team)
      : scene_(scene), own_(own), at_(at), team_(team) {}

  // The moment and the motion at which forces are taken.
  struct Moment {
    const CardLevel& level;
    CardCell cell;
    const CardRow *velocity, *spin;
  };

  // Sets the loads of the pairs, and own.springs_after to their springs after the step.
  [[gnu::noinline]] CardTotals evaluate(const Moment& moment, CardField field) const {
    const PairParameters& parameters = parameters_of(moment, field);
    return team_.template reduce<CardStresses<terms>::numbers, 1>(
        at_.pairs, [&](std::uint32_t p, auto& sums) PECLET_INLINE_LAMBDA {
          const Seen pair = see(moment, parameters, p);
          sums.sum[CardStresses<terms>::not_finite] += pair.is_finite ? 0 : 1;
          if (!pair.is_near) {
            leave(p, {});
            store_springs(p, {});
            return;
          }
          PairSpringsOf<CardNumber> springs = springs_of(p);
          PairLoadOf<CardNumber> load{};
          const TermLoadsOf<CardNumber> loads = pair_terms<terms>(
              parameters, *pair.kind, pair.geometry, pair.motion, springs,
              [] { return PairNormalsOf<CardNumber>{}; },
              [&](StressTerm part, const CardVector& force)
                  PECLET_INLINE_LAMBDA { add_stress<terms>(sums, part, pair.geometry, force); });
          store_springs(p, springs);
          load = loads.lubrication;
          load.force += loads.conservative + loads.contact_normal + loads.contact_damping;
          add_stress<terms>(sums, StressTerm::lubrication, pair.geometry, loads.lubrication.force);
          if (scene_.touching && loads.overlap > 0.0) {
            const double relative = loads.overlap.v / pair.kind->smaller_radius;
            sums.sum[CardStresses<terms>::contacts] += 1;
            sums.sum[CardStresses<terms>::overlaps] += relative;
            sums.largest[0] = sums.largest[0] < relative ? relative : sums.largest[0];
            add_stress<terms>(sums, StressTerm::contact_normal, pair.geometry, loads.contact_normal);
            add_stress<terms>(sums, StressTerm::contact_damping, pair.geometry, loads.contact_damping);
          }
          for_each_spring_law<terms>([&](auto law) PECLET_INLINE_LAMBDA {
            using Law = decltype(law);
            const PairLoadOf<CardNumber>& of_spring = Law::of(loads.springs);
            if constexpr (Law::has_force) {
              load.force += of_spring.force;
              if (loads.overlap > 0.0) {
                add_stress<terms>(sums, StressTerm::friction, pair.geometry, of_spring.force);
              }
            }
            load.torque_first += of_spring.torque_first;
            load.torque_second += of_spring.torque_second;
          });
          leave(p, load);
        });
  }

  // Sets the loads of the noise of pairs, and of the resistance beside it.
  [[gnu::noinline]] CardTotals evaluate_noise(const Moment& moment, std::uint64_t part) const {
    const NoiseKey key = {at_.seed, static_cast<std::uint64_t>(Purpose::pair_noise), at_.step, part};
    return evaluate_noise_of(
        moment, [&](std::uint32_t p) PECLET_INLINE_LAMBDA { return normals_of_pair(key, own_.pair[p]); });
  }
  // Does so with theta and chi that normals(p) returns.
  template <class Normals>
  PECLET_ALWAYS_INLINE CardTotals evaluate_noise_of(const Moment& moment, Normals&& normals) const {
    const PairParameters& parameters = parameters_of(moment, CardField::with_noise);
    return team_.template reduce<CardStresses<noise_terms>::numbers, 1>(
        at_.pairs, [&](std::uint32_t p, auto& sums) PECLET_INLINE_LAMBDA {
          const Seen pair = see(moment, parameters, p);
          sums.sum[CardStresses<noise_terms>::not_finite] += pair.is_finite ? 0 : 1;
          if (!pair.is_near) {
            leave(p, {});
            return;
          }
          PairSpringsOf<CardNumber> no_springs{};
          const TermLoadsOf<CardNumber> loads = pair_terms<noise_terms>(
              parameters, *pair.kind, pair.geometry, pair.motion, no_springs,
              [&]() PECLET_INLINE_LAMBDA { return normals(p); }, [](StressTerm, const CardVector&) {});
          PairLoadOf<CardNumber> load = loads.lubrication;
          load += loads.noise;
          add_stress<noise_terms>(sums, StressTerm::lubrication, pair.geometry, loads.lubrication.force);
          add_stress<noise_terms>(sums, StressTerm::brownian_lubrication, pair.geometry, loads.noise.force);
          leave(p, load);
        });
  }

  // Sets the links of the pairs, with the springs where the part of the step began.
  [[gnu::noinline]] void assemble(const Moment& moment, CardField field) const {
    const PairParameters& parameters = parameters_of(moment, field);
    team_.each(at_.pairs, [&](std::uint32_t p) PECLET_INLINE_LAMBDA {
      const Seen pair = see(moment, parameters, p);
      if (!pair.is_near) {
        own_.link[p] = {};
        return;
      }
      const double timestep = moment.level.timestep;
      PairResistanceOf<CardNumber> sum = scaled(CardNumber{timestep}, tangent(parameters, pair));
      add_stiffness(sum, terms, parameters.contact, *pair.kind, pair.ahead,
                    {.resistance = timestep,
                     .normal = timestep * (0.5 * timestep),
                     .tangential = timestep * timestep * parameters.felt_share},
                    [&]() PECLET_INLINE_LAMBDA { return held(parameters, pair, p); });
      const CardVector& n = pair.geometry.normal;
      const auto single = [](CardNumber x) { return static_cast<float>(x.v); };
      own_.link[p] = {{single(n.x), single(n.y), single(n.z)},
                      single(sum.squeeze),
                      single(sum.shear),
                      single(sum.pump_first),
                      single(sum.pump_second),
                      single(sum.twist_cross)};
      own_.twist[p] = {single(sum.twist_first), single(sum.twist_second)};
    });
  }

  // Sets the loads that a change of the motion adds to pairs (ActedStress::end()).
  [[gnu::noinline]] CardTotals leave_change(const Moment& moment, const CardRow* velocity,
                                            const CardRow* spin) const {
    const PairParameters& parameters = parameters_of(moment, CardField::ahead);
    const double timestep = moment.level.timestep;
    return team_.template reduce<CardStresses<terms>::numbers, 1>(
        at_.pairs, [&](std::uint32_t p, auto& sums) PECLET_INLINE_LAMBDA {
          const Seen pair = see(moment, parameters, p);
          if (!pair.is_near) {
            leave(p, {});
            return;
          }
          const CardPair& ends = own_.pair[p];
          const auto gained = [&](const CardRow* now, const CardRow* before, std::uint32_t i) {
            return vector(now[i]) - vector(before[i]);
          };
          const PairMotionOf<CardNumber> change = {
              gained(velocity, moment.velocity, ends.second) - gained(velocity, moment.velocity, ends.first),
              gained(spin, moment.spin, ends.first), gained(spin, moment.spin, ends.second)};
          const CardVector& n = pair.geometry.normal;
          const CardNumber approach = (0.5 * timestep) * dot(change.velocity, n);
          PairLoadOf<CardNumber> load = lubrication_load(tangent(parameters, pair), pair.geometry, change);
          add_stress<terms>(sums, StressTerm::lubrication, pair.geometry, load.force);
          const auto push = [&](StressTerm term, const CardVector& force) PECLET_INLINE_LAMBDA {
            add_stress<terms>(sums, term, pair.geometry, force);
            load.force += force;
          };
          if (positive_stiffness(pair.kind->conservative, pair.ahead, 1) > 0.0) {
            for_each_conservative_law(
                [&](StressTerm part, const auto& law) PECLET_INLINE_LAMBDA {
                  if (!(law.range > 0) || !(pair.ahead.distance < law.range)) return;
                  const CardNumber stiffness = law.stiffness(pair.ahead.surface_distance());
                  push(part, (stiffness * approach) * n);
                },
                pair.kind->conservative);
          }
          if (pair.ahead.overlap() > 0.0) {
            push(StressTerm::contact_normal, (parameters.contact.normal_stiffness * approach) * n);
            push(StressTerm::contact_damping,
                 contact_damping_force(parameters.contact.normal_damping, pair.geometry, change));
            if constexpr (terms.friction) {
              PairResistanceOf<CardNumber> springs{};
              add_springs(springs, terms, contact_of(parameters.contact, *pair.kind, pair.ahead),
                          {.resistance = 1, .tangential = timestep * parameters.felt_share},
                          held(parameters, pair, p));
              const PairLoadOf<CardNumber> stretched = lubrication_load(springs, pair.geometry, change);
              load.torque_first += stretched.torque_first;
              load.torque_second += stretched.torque_second;
              push(StressTerm::friction, stretched.force);
            }
          }
          leave(p, load);
        });
  }

  // Returns the sums over the pairs of a row.
  struct RowLoad {
    CardVector force, torque;
  };
  PECLET_ALWAYS_INLINE RowLoad pairs_of_row(std::uint32_t i) const {
    RowLoad sum;
    for (std::uint32_t e = own_.end_begin[i]; e < own_.end_begin[i + 1]; ++e) {
      const std::uint32_t pair = own_.end[e].pair_and_side / 2;
      const CardVector force = vector(own_.pair_force[pair]);
      if (own_.end[e].pair_and_side % 2 == 0) {
        sum.force += force;
        sum.torque += vector(own_.torque_first[pair]);
      } else {
        sum.force -= force;
        sum.torque += vector(own_.torque_second[pair]);
      }
    }
    return sum;
  }

  // Returns the standard normal vectors of a sphere in this part of the step.
  PairNormalsOf<CardNumber> normals_of_sphere(std::uint32_t i, std::uint64_t part) const {
    return normals({at_.seed, static_cast<std::uint64_t>(Purpose::one_body_noise), at_.step, part}, i, 0);
  }

  // Returns kT / (V Delta) times the structural Brownian stress's sum (observables/structure.h), for V = 1.
  CardTotals structure(const CardCell& cell, double shell) const {
    return team_.reduce<6, 0>(at_.pairs, [&](std::uint32_t p, auto& sums) {
      const PairKind& kind = kind_of(own_.pair[p]);
      const CardVector r = separation(own_.pair[p], cell);
      const CardNumber squared = dot(r, r);
      const auto within = [&](double radius) {
        const double reach = kind.sum_of_radii + shell * radius;
        return squared < CardNumber{reach * reach} ? 1 : 0;
      };
      const int sides = within(kind.radius_first) + within(kind.radius_second);
      if (sides == 0) return;
      add(sums.sum, (static_cast<double>(sides) / squared) * symmetric_dyad(r, r));
    });
  }

  PECLET_ALWAYS_INLINE static CardVector vector(const CardRow& row) { return {row.x, row.y, row.z}; }
  PECLET_ALWAYS_INLINE static CardRow row(const CardVector& v) { return {v.x.v, v.y.v, v.z.v, 0}; }

  // Adds the six components of a tensor.
  PECLET_ALWAYS_INLINE static void add(double* sum, const SymmetricTensorOf<CardNumber>& t) {
    sum[0] += t.xx.v;
    sum[1] += t.yy.v;
    sum[2] += t.zz.v;
    sum[3] += t.xy.v;
    sum[4] += t.xz.v;
    sum[5] += t.yz.v;
  }

 private:
  struct Seen {
    PairGeometryOf<CardNumber> geometry, ahead;  // the latter at the distance at which forces are taken
    PairMotionOf<CardNumber> motion;
    const PairKind* kind;
    bool is_near, is_finite;
  };

  const PairParameters& parameters_of(const Moment& moment, CardField field) const {
    return moment.level.field[static_cast<std::size_t>(field)];
  }
  const PairKind& kind_of(const CardPair& pair) const {
    return scene_.kinds[scene_.size_class[pair.first] * scene_.classes + scene_.size_class[pair.second]];
  }
  PECLET_ALWAYS_INLINE CardVector separation(const CardPair& pair, const CardCell& cell) const {
    const double kx = pair.image[0], ky = pair.image[1], kz = pair.image[2];
    CardVector r = vector(own_.position[pair.second]) - vector(own_.position[pair.first]);
    return r += CardVector{kx * cell.edge_x + ky * cell.tilt, ky * cell.edge_y, kz * cell.edge_z};
  }

  PECLET_ALWAYS_INLINE Seen see(const Moment& moment, const PairParameters& parameters,
                                std::uint32_t p) const {
    const CardPair& pair = own_.pair[p];
    Seen seen;
    seen.kind = &kind_of(pair);
    const CardVector r = separation(pair, moment.cell);
    const CardNumber squared = dot(r, r);
    const double range = seen.kind->range + kind_reach(parameters, *seen.kind);
    seen.is_near = squared <= CardNumber{range * range};
    seen.is_finite = squared < CardNumber{__builtin_inf()};
    const CardNumber distance = square_root(squared);
    seen.geometry = {r, (1.0 / distance) * r, distance, seen.kind->sum_of_radii};
    seen.motion.velocity = vector(moment.velocity[pair.second]) - vector(moment.velocity[pair.first]);
    seen.motion.velocity.x += scene_.rate * moment.cell.edge_y * static_cast<double>(pair.image[1]);
    seen.motion.spin_first = vector(moment.spin[pair.first]);
    seen.motion.spin_second = vector(moment.spin[pair.second]);
    seen.ahead = seen.geometry;
    seen.ahead.distance += parameters.approach_time * dot(seen.motion.velocity, seen.geometry.normal);
    return seen;
  }

  PECLET_ALWAYS_INLINE PairResistanceOf<CardNumber> tangent(const PairParameters& parameters,
                                                            const Seen& pair) const {
    return scene_.lubricated ? tangent_resistance(pair.kind->resistance, parameters.step_resistance,
                                                  pair.kind->gap, pair.kind->lubrication_range, pair.geometry,
                                                  dot(pair.motion.velocity, pair.geometry.normal))
                             : PairResistanceOf<CardNumber>{};
  }

  PECLET_ALWAYS_INLINE OfEachSpring<CardNumber> held(const PairParameters& parameters, const Seen& pair,
                                                     std::uint32_t p) const {
    return held_shares(terms, contact_of(parameters.contact, *pair.kind, pair.ahead), pair.motion,
                       parameters.spring_timestep * parameters.felt_share, springs_of(p));
  }

  PECLET_ALWAYS_INLINE void leave(std::uint32_t p, const PairLoadOf<CardNumber>& load) const {
    own_.pair_force[p] = row(load.force);
    own_.torque_first[p] = row(load.torque_first);
    own_.torque_second[p] = row(load.torque_second);
  }

  PECLET_ALWAYS_INLINE PairSpringsOf<CardNumber> springs_of(std::uint32_t p) const {
    PairSpringsOf<CardNumber> springs{};
    for_each_spring_law<terms>([&](auto law) PECLET_INLINE_LAMBDA {
      const double* const from = own_.springs + decltype(law)::component * std::size_t{own_.room.pairs} + p;
      decltype(law)::of(springs) = {from[0], from[own_.room.pairs], from[2 * std::size_t{own_.room.pairs}]};
    });
    if constexpr (terms.kinetic) springs.slides = own_.springs[6 * std::size_t{own_.room.pairs} + p];
    return springs;
  }
  PECLET_ALWAYS_INLINE void store_springs(std::uint32_t p, const PairSpringsOf<CardNumber>& springs) const {
    for_each_spring_law<terms>([&](auto law) PECLET_INLINE_LAMBDA {
      double* const to = own_.springs_after + decltype(law)::component * std::size_t{own_.room.pairs} + p;
      const CardVector& spring = decltype(law)::of(springs);
      to[0] = spring.x.v;
      to[own_.room.pairs] = spring.y.v;
      to[2 * std::size_t{own_.room.pairs}] = spring.z.v;
    });
    if constexpr (terms.kinetic) own_.springs_after[6 * std::size_t{own_.room.pairs} + p] = springs.slides.v;
  }

  template <Terms of, class Sums>
  PECLET_ALWAYS_INLINE static void add_stress(Sums& sums, StressTerm term,
                                              const PairGeometryOf<CardNumber>& pair,
                                              const CardVector& force) {
    add(sums.sum + CardStresses<of>::place(static_cast<std::size_t>(term)),
        symmetric_dyad(pair.separation, force));
  }

  static PairNormalsOf<CardNumber> normals(const NoiseKey& key, std::uint64_t identity, std::uint64_t image) {
    NormalBlockOf<1> block;
    fill_block(key, &identity, &image, block);
    const auto normal = [&](int k) { return CardNumber{static_cast<double>(block.value[k][0])}; };
    return {{normal(0), normal(1), normal(2)}, {normal(3), normal(4), normal(5)}};
  }
  static PairNormalsOf<CardNumber> normals_of_pair(const NoiseKey& key, const CardPair& pair) {
    return normals(key, pair_identity(pair.first, pair.second),
                   image_identity({pair.image[0], pair.image[1], pair.image[2]}));
  }

  const CardScene& scene_;
  const CardRealisation& own_;
  const CardProgress& at_;
  const CardTeam& team_;
};

}  // namespace peclet::engine
