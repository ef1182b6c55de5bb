// The loop over pairs, compiled for each recipe with double and with the lanes of each instruction set.
//
// Included by one file for each instruction set, compiled with its flags. This header and those that it
// includes have only templates on the number and plain data, so that no other file shares code with it.
#pragma once

#include <utility>

#include "engine/kernels/one_lane.h"
#include "engine/kernels/pair_kernels.h"
#include "engine/kernels/pair_terms.h"
#include "engine/terms/pair.h"

namespace peclet::engine {

// The sums of a pass over pairs, lane by lane. Pairs are added in the order of the list.
template <class Real>
struct LaneSumsOf {
  SymmetricTensorOf<Real> stress[count_of_stress_terms];
  Real overlaps{}, largest_overlap{};
  std::uint64_t contacts = 0;
  unsigned not_finite = 0;

  PECLET_ALWAYS_INLINE void add_stress(StressTerm term, const PairGeometryOf<Real>& pair,
                                       const Vector3Of<Real>& force) {
    stress[static_cast<std::size_t>(term)] += symmetric_dyad(pair.separation, force);
  }

  // Counts the pairs that overlap and adds up their overlaps. Returns true if any does.
  PECLET_ALWAYS_INLINE bool count_contacts(const PairKind& kind, const Real& overlap) {
    const unsigned touching = bits(overlap > Real{});
    if (touching == 0) return false;
    contacts += static_cast<std::uint64_t>(__builtin_popcount(touching));
    const Real relative = (1 / kind.smaller_radius) * overlap;
    overlaps += larger(Real{}, relative);
    largest_overlap = larger(largest_overlap, relative);
    return true;
  }

  // Sets `total` to the sums over all lanes.
  PECLET_ALWAYS_INLINE void store(PairSums& total) const {
    for (std::size_t t = 0; t < count_of_stress_terms; ++t) {
      const SymmetricTensorOf<Real>& s = stress[t];
      total.stress[t] = {sum_of_lanes(s.xx), sum_of_lanes(s.yy), sum_of_lanes(s.zz),
                         sum_of_lanes(s.xy), sum_of_lanes(s.xz), sum_of_lanes(s.yz)};
    }
    total.contacts = static_cast<double>(contacts);
    total.overlaps = sum_of_lanes(overlaps);
    total.largest_overlap = largest_lane(largest_overlap);
    total.finite = not_finite == 0;
  }
};

// NOLINTNEXTLINE(readability-non-const-parameter): callers write to the row
PECLET_ALWAYS_INLINE Row& row_of(double* rows, std::size_t number) {
  return *reinterpret_cast<Row*>(rows + 4 * number);
}

// Adds the loads of pairs [begin, begin + count) of a run to the rows of their particles, pair after pair.
// Loads on particles of other blocks go to the rows of crossing pairs. `mirrored`: these are the first ones.
template <bool mirrored, class Real>
PECLET_ALWAYS_INLINE void leave_load(const PairLoadOf<Real>& load, const PairRun& run, std::uint32_t begin,
                                     int count, const std::uint32_t* first, const std::uint32_t* second,
                                     const PairKernelOutput& out) {
  const RowsOf<Real> force = scattered(load.force), torque_first = scattered(load.torque_first),
                     torque_second = scattered(load.torque_second);
  for (int k = 0; k < width_of<Real>; ++k) {
    if (k == count) break;
    if constexpr (mirrored) {
      const std::size_t j = second[k] - out.first_particle;
      row_of(out.force, j) -= force.row[k];
      row_of(out.torque, j) += torque_second.row[k];
      const std::size_t c = run.crossing + (begin - run.begin) + static_cast<std::uint32_t>(k);
      row_of(out.crossing, 2 * c) = force.row[k];
      row_of(out.crossing, 2 * c + 1) = torque_first.row[k];
      continue;
    }
    const std::size_t i = first[k] - out.first_particle;
    row_of(out.force, i) += force.row[k];
    row_of(out.torque, i) += torque_first.row[k];
    if (run.crossing == within_block) {
      const std::size_t j = second[k] - out.first_particle;
      row_of(out.force, j) -= force.row[k];
      row_of(out.torque, j) += torque_second.row[k];
    } else {
      const std::size_t c = run.crossing + (begin - run.begin) + static_cast<std::uint32_t>(k);
      row_of(out.crossing, 2 * c) = -force.row[k];
      row_of(out.crossing, 2 * c + 1) = torque_second.row[k];
    }
  }
}

// Up to eight pairs of one run, for which noise is drawn together when the first one needs it.
struct EightPairs {
  std::uint32_t begin, end;
  bool drawn = false;
  NormalBlock normals;
};

// Returns the non-uniform flow at the spheres of pairs. It is not inlined: one copy serves all recipes.
template <class Real>
[[gnu::noinline]] PairVariationOf<Real> variation_at(const FlowRows& flow, const std::uint32_t* first,
                                                     const std::uint32_t* second) {
  const auto strain = [&](const std::uint32_t* index) PECLET_INLINE_LAMBDA {
    const Vector3Of<Real> along = gather_rows(flow.strain_along, index, Real{});
    const Vector3Of<Real> across = gather_rows(flow.strain_across, index, Real{});
    return SymmetricTensorOf<Real>{along.x, along.y, along.z, across.x, across.y, across.z};
  };
  return {gather_rows(flow.velocity, second, Real{}) - gather_rows(flow.velocity, first, Real{}),
          gather_rows(flow.spin, first, Real{}), gather_rows(flow.spin, second, Real{}), strain(first),
          strain(second)};
}

// Returns the springs that the terms have, of pairs from `begin` on.
template <class Real>
PECLET_ALWAYS_INLINE PairSpringsOf<Real> springs_at(const PairKernelInput& in, const Terms& terms,
                                                    std::uint32_t begin, int count) {
  PairSpringsOf<Real> springs;
  for_each_spring_law(terms, [&](auto law) PECLET_INLINE_LAMBDA {
    const auto load = [&](std::size_t c) {
      return load_lanes(in.springs[decltype(law)::component + c] + begin, count, Real{});
    };
    decltype(law)::of(springs) = {load(0), load(1), load(2)};
  });
  if (terms.kinetic) springs.slides = load_lanes(in.slides + begin, count, Real{});
  return springs;
}

// Up to width_of<Real> pairs of one run. `mirrored`: their first particles lie in other blocks.
template <class Real, Terms terms, bool mirrored>
class PairGroup {
 public:
  PECLET_ALWAYS_INLINE PairGroup(const PairKernelInput& in, const PairRun& run, EightPairs& eight,
                                 std::uint32_t begin, int count)
      : in_(in), run_(run), kind_(in.kinds[run.kind]), eight_(eight), begin_(begin), count_(count) {
    for (int k = 0; k < width_of<Real>; ++k) {
      // Lanes without a pair repeat the first one and are masked or skipped below.
      const Pair& pair = in.pairs[begin + static_cast<std::uint32_t>(k < count ? k : 0)];
      first_[k] = pair.first;
      second_[k] = pair.second;
      image_[k] = pair.image;
    }
  }

  PECLET_ALWAYS_INLINE void add(const PairKernelOutput& out, LaneSumsOf<Real>& sums) {
    Vector3Of<Real> r =
        gather_rows(in_.position, second_, Real{}) - gather_rows(in_.position, first_, Real{});
    if (run_.imaged) {
      r += gather_rows(in_.image_displacement, image_, Real{});
    }
    const auto listed = listed_lanes(count_, Real{});
    const Real squared = dot(r, r);
    sums.not_finite |= bits(listed & !(squared < Real{__builtin_inf()}));
    const double range = kind_.range + kind_reach(in_.parameters, kind_);
    const auto near = listed & (squared <= Real{range * range});
    if (!any(near)) {
      forget_springs();
      leave_nothing(out);
      return;
    }
    // Lanes out of range compute with a distance at which every term is zero.
    PairGeometryOf<Real> shape;
    shape.separation = where(near, r);
    shape.distance = select(near, square_root(squared), Real{2 * range});
    shape.normal = (1.0 / shape.distance) * shape.separation;
    shape.sum_of_radii = kind_.sum_of_radii;
    PairMotionOf<Real> motion;
    motion.velocity = gather_rows(in_.velocity, second_, Real{}) - gather_rows(in_.velocity, first_, Real{});
    if (run_.imaged) {
      motion.velocity += gather_rows(in_.image_velocity, image_, Real{});
    }
    motion.spin_first = gather_rows(in_.spin, first_, Real{});
    motion.spin_second = gather_rows(in_.spin, second_, Real{});

    PairSpringsOf<Real> springs = springs_at<Real>(in_, terms, begin_, count_);
    const TermLoadsOf<Real> loads = pair_terms<terms>(
        in_.parameters, kind_, shape, motion, springs, [this] { return normals(); },
        [&](StressTerm part, const Vector3Of<Real>& force)
            PECLET_INLINE_LAMBDA { sums.add_stress(part, shape, force); },
        [this]() PECLET_INLINE_LAMBDA { return variation_at<Real>(in_.varying, first_, second_); });
    store_springs(springs);
    add_sums(shape, loads, sums);
    leave(total(loads), out);
  }

 private:
  PECLET_ALWAYS_INLINE static PairLoadOf<Real> total(const TermLoadsOf<Real>& loads) {
    PairLoadOf<Real> sum = loads.lubrication;
    if constexpr (terms.noise) {
      sum += loads.noise;
    }
    if constexpr (terms.conservative) {
      sum.force += loads.conservative;
    }
    if constexpr (terms.contact) {
      sum.force += loads.contact_normal;
    }
    if constexpr (terms.damping) {
      sum.force += loads.contact_damping;
    }
    for_each_spring_law<terms>([&](auto law) PECLET_INLINE_LAMBDA {
      const PairLoadOf<Real>& load = decltype(law)::of(loads.springs);
      if constexpr (decltype(law)::has_force) sum.force += load.force;
      sum.torque_first += load.torque_first;
      sum.torque_second += load.torque_second;
    });
    return sum;
  }

  // Adds contacts and stress to the sums; that of conservative laws comes from pair_terms() directly.
  PECLET_ALWAYS_INLINE void add_sums(const PairGeometryOf<Real>& shape, const TermLoadsOf<Real>& loads,
                                     LaneSumsOf<Real>& sums) {
    const auto add = [&](StressTerm term, const Vector3Of<Real>& force) {
      sums.add_stress(term, shape, force);
    };
    if constexpr (terms.lubrication) {
      add(StressTerm::lubrication, loads.lubrication.force);
    }
    if constexpr (terms.noise) {
      add(StressTerm::brownian_lubrication, loads.noise.force);
    }
    if constexpr (terms.contact) {
      if (!sums.count_contacts(kind_, loads.overlap)) return;
      add(StressTerm::contact_normal, loads.contact_normal);
      if constexpr (terms.damping) {
        add(StressTerm::contact_damping, loads.contact_damping);
      }
      for_each_spring_law<terms>([&](auto law) PECLET_INLINE_LAMBDA {
        using Law = decltype(law);
        if constexpr (Law::has_force) add(StressTerm::friction, Law::of(loads.springs).force);
      });
    }
  }

  PECLET_ALWAYS_INLINE void leave(const PairLoadOf<Real>& load, const PairKernelOutput& out) const {
    leave_load<mirrored>(load, run_, begin_, count_, first_, second_, out);
  }

  // Writes zero to the rows of crossing pairs, which are not cleared before an evaluation.
  PECLET_ALWAYS_INLINE void leave_nothing(const PairKernelOutput& out) const {
    if (run_.crossing == within_block) return;
    for (int k = 0; k < count_; ++k) {
      const std::size_t c = run_.crossing + (begin_ - run_.begin) + static_cast<std::uint32_t>(k);
      row_of(out.crossing, 2 * c) = Row{};
      row_of(out.crossing, 2 * c + 1) = Row{};
    }
  }

  PECLET_ALWAYS_INLINE PairNormalsOf<Real> normals() const {
    PairNormalsOf<Real> result;
    Real* const parts[6] = {&result.theta.x, &result.theta.y, &result.theta.z,
                            &result.chi.x,   &result.chi.y,   &result.chi.z};
    if (in_.given_normals != nullptr) {
      for (int k = 0; k < count_; ++k) {
        for (int c = 0; c < 6; ++c) {
          set_lane(*parts[c], k,
                   in_.given_normals[6 * (std::size_t{begin_} + static_cast<std::size_t>(k)) +
                                     static_cast<std::size_t>(c)]);
        }
      }
      return result;
    }
    if (!eight_.drawn) draw();
    const auto offset = static_cast<int>(begin_ - eight_.begin);
    for (int c = 0; c < 6; ++c) {
      for (int k = 0; k < width_of<Real>; ++k) {
        set_lane(*parts[c], k, static_cast<double>(eight_.normals.value[c][offset + k]));
      }
    }
    return result;
  }

  // Draws the noise of all eight pairs.
  void draw() const {
    std::uint64_t identity[identities_per_block] = {}, image[identities_per_block] = {};
    for (std::uint32_t p = eight_.begin; p < eight_.end; ++p) {
      const Pair& pair = in_.pairs[p];
      identity[p - eight_.begin] = pair_identity(in_.id[pair.first], in_.id[pair.second]);
      image[p - eight_.begin] = in_.image_keys[pair.image];
    }
    in_.fill_normals(in_.noise, identity, run_.imaged ? image : nullptr, eight_.normals);
    eight_.drawn = true;
  }

  PECLET_ALWAYS_INLINE void store_springs(const PairSpringsOf<Real>& springs) const {
    for_each_spring_law<terms>([&](auto law) PECLET_INLINE_LAMBDA {
      double* const* const to = in_.springs + decltype(law)::component;
      const Vector3Of<Real>& spring = decltype(law)::of(springs);
      store_lanes(to[0] + begin_, count_, spring.x);
      store_lanes(to[1] + begin_, count_, spring.y);
      store_lanes(to[2] + begin_, count_, spring.z);
    });
    if constexpr (terms.kinetic) {
      store_lanes(in_.slides + begin_, count_, springs.slides);
    }
  }
  PECLET_ALWAYS_INLINE void forget_springs() const {
    if constexpr (terms.friction) {
      store_springs({});
    }
  }

  const PairKernelInput& in_;
  const PairRun& run_;
  const PairKind& kind_;
  EightPairs& eight_;
  std::uint32_t begin_;
  int count_;
  std::uint32_t first_[width_of<Real>], second_[width_of<Real>], image_[width_of<Real>];
};

// Prefetches, some pairs ahead, the rows of the particles in other blocks, which are seldom in a cache.
inline constexpr std::uint32_t pairs_ahead = 16;
PECLET_ALWAYS_INLINE void ask_for_rows(const PairKernelInput& in, const PairRun& run, std::uint32_t begin,
                                       std::uint32_t end) {
  if (run.crossing == within_block) return;
  end = end + pairs_ahead < run.end ? end + pairs_ahead : run.end;
  for (std::uint32_t p = begin + pairs_ahead; p < end; ++p) {
    const std::size_t row = 4 * std::size_t{run.first_is_away ? in.pairs[p].first : in.pairs[p].second};
    __builtin_prefetch(in.position + row);
    __builtin_prefetch(in.velocity + row);
    __builtin_prefetch(in.spin + row);
  }
}

template <class Real, Terms terms, bool mirrored>
[[gnu::noinline]] void add_runs(const PairKernelInput& in, const PairRun* runs, const PairRun* end,
                                const PairKernelOutput& out, PairSums& total) {
  LaneSumsOf<Real> sums;
  for (const PairRun* run = runs; run < end; ++run) {
    EightPairs eight;
    for (eight.begin = run->begin; eight.begin < run->end; eight.begin = eight.end) {
      const std::uint32_t left = run->end - eight.begin;
      eight.end = left < identities_per_block ? run->end : eight.begin + identities_per_block;
      eight.drawn = false;
      ask_for_rows(in, *run, eight.begin, eight.end);
      for (std::uint32_t begin = eight.begin; begin < eight.end; begin += width_of<Real>) {
        const auto rest = static_cast<int>(eight.end - begin);
        PairGroup<Real, terms, mirrored>(in, *run, eight, begin,
                                         rest < width_of<Real> ? rest : width_of<Real>)
            .add(out, sums);
      }
    }
  }
  sums.store(total);
}

// Runs the loop over the pairs of a block. Mirrored runs, the last ones of a block, have a loop of their own:
// the compiler makes slower code of one loop for both.
template <class Real, Terms terms>
void run_pair_kernel(const PairKernelInput& in, const PairRun* runs, std::size_t count,
                     const PairKernelOutput& out) {
  const PairRun *const end = runs + count, *mirrored = runs;
  while (mirrored < end && !mirrored->first_is_away) ++mirrored;
  add_runs<Real, terms, false>(in, runs, mirrored, out, out.sums[0]);
  if (mirrored < end) {
    add_runs<Real, terms, true>(in, mirrored, end, out, out.sums[1]);
  } else {
    out.sums[1] = {};
  }
}

// Returns the kernel of a recipe, or null if it is not compiled.
template <class Real, unsigned code>
constexpr PairKernel kernel_of_code() {
  constexpr Terms terms = decoded_terms(code);
  if constexpr (terms.valid() && compiled_terms(terms) == terms) {
    return &run_pair_kernel<Real, terms>;
  } else {
    return nullptr;
  }
}

template <class Real, unsigned... codes>
constexpr PairKernelTable make_pair_kernels(std::integer_sequence<unsigned, codes...> /*codes*/) {
  return {{kernel_of_code<Real, codes>()...}};
}

template <class Real>
constexpr PairKernelTable pair_kernels_of() {
  return make_pair_kernels<Real>(std::make_integer_sequence<unsigned, count_of_codes>{});
}

}  // namespace peclet::engine
