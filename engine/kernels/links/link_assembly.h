// Couplings of the pairs of a list, computed like their forces: several pairs of one kind side by side.
#pragma once

#include "engine/kernels/lanes/single_access.h"
#include "engine/kernels/links/link_kernels.h"
#include "engine/kernels/pairs/pair_coupling.h"
#include "engine/kernels/pairs/pair_terms.h"

namespace peclet::engine {

// Pairs of one run, as many as a number holds.
template <class Real>
class LinkedPairs {
 public:
  PECLET_ALWAYS_INLINE LinkedPairs(const PairKernelInput& in, const PairRun& run, std::uint32_t begin,
                                   int count)
      : in_(in), kind_(in.kinds[run.kind]), begin_(begin), count_(count) {
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
    near_ = bits(listed_lanes(count, Real{}) & (squared <= Real{range * range}));
    shape_ = {r, {}, square_root(squared), kind_.sum_of_radii};
    shape_.normal = (1.0 / shape_.distance) * r;
    ahead_ = shape_;
    ahead_.distance += in.parameters.approach_time * dot(motion_.velocity, shape_.normal);
  }

  unsigned near() const { return near_; }

  PECLET_ALWAYS_INLINE PairResistanceOf<Real> coupling(const Terms& terms, const LinkWeights& weights) const {
    PairResistanceOf<Real> sum{};
    const PairParameters& parameters = in_.parameters;
    if (terms.lubrication) {
      const double inner_gap = parameters.lubrication.inner_gap;
      const Real closing = dot(motion_.velocity, shape_.normal);
      const ResistanceModesOf<Real> modes = resistance_modes(
          parameters.step_resistance, parameters.lubrication, kind_.lubrication_range, shape_, closing);
      add_scaled(sum, Real{weights.timestep}, pair_resistance(kind_.resistance, modes));
      // The resistance at the distance that the velocities lead to: d/dv of X_A(r + t v) v.
      const Real slope = squeeze_slope(kind_.resistance, inner_gap, kind_.sum_of_radii, modes);
      sum.squeeze = larger(sum.squeeze + (weights.timestep * weights.resistance_time) * slope * closing,
                           0.5 * sum.squeeze);
    }
    add_stiffness(sum, terms, parameters.contact, kind_, ahead_,
                  {.resistance = weights.timestep,
                   .normal = weights.timestep * weights.normal_time,
                   .tangential = weights.timestep * weights.timestep},
                  [&]() PECLET_INLINE_LAMBDA { return held_springs(terms); });
    return sum;
  }

  PECLET_ALWAYS_INLINE void emit(LinkGroup* groups, std::size_t& links,
                                 const PairResistanceOf<Real>& coupling) const {
    for (int k = 0; k < count_; ++k) {
      if ((near_ >> k & 1U) == 0) {
        continue;
      }
      LinkGroup& group = groups[links / links_per_group];
      const auto place = static_cast<int>(links % links_per_group);
      ++links;
      group.first[place] = first_[k];
      group.second[place] = second_[k];
      const auto put = [&](Floats& to, const Real& from) { to[place] = static_cast<float>(lane(from, k)); };
      put(group.normal[0], shape_.normal.x);
      put(group.normal[1], shape_.normal.y);
      put(group.normal[2], shape_.normal.z);
      put(group.squeeze, coupling.squeeze);
      put(group.shear, coupling.shear);
      put(group.pump_first, coupling.pump_first);
      put(group.pump_second, coupling.pump_second);
      put(group.twist_first, coupling.twist_first);
      put(group.twist_cross, coupling.twist_cross);
      put(group.twist_second, coupling.twist_second);
    }
  }

 private:
  PECLET_ALWAYS_INLINE HeldSprings<Real> held_springs(const Terms& terms) const {
    const PairParameters& parameters = in_.parameters;
    const auto spring = [&](int c) {
      return Vector3Of<Real>{load_lanes(in_.springs[c] + begin_, count_, Real{}),
                             load_lanes(in_.springs[c + 1] + begin_, count_, Real{}),
                             load_lanes(in_.springs[c + 2] + begin_, count_, Real{})};
    };
    const Real overlap = larger(ahead_.overlap(), Real{0.0});
    const Real elapsed{parameters.spring_timestep};
    const ContactLeversOf<Real> lever = contact_levers(kind_.radius_first, kind_.radius_second, ahead_);
    HeldSprings<Real> held{};
    held.tangential = held_share(spring(0), shape_.normal, elapsed * slip_velocity(lever, shape_, motion_),
                                 longest_spring(parameters.contact, overlap));
    if (terms.rolling) {
      held.rolling = held_share(spring(3), shape_.normal,
                                elapsed * rolling_velocity(kind_.reduced_diameter, shape_, motion_),
                                longest_rolling_spring(parameters.contact, overlap));
    }
    return held;
  }

  PairGeometryOf<Real> shape_, ahead_;
  PairMotionOf<Real> motion_;
  std::uint32_t first_[width_of<Real>], second_[width_of<Real>], image_[width_of<Real>];
  const PairKernelInput& in_;
  const PairKind& kind_;
  std::uint32_t begin_;
  int count_;
  unsigned near_;
};

template <class Real>
std::size_t assemble_links(const PairKernelInput& in, const PairRun* runs, std::size_t count,
                           const Terms& terms, const LinkWeights& weights, LinkGroup* groups) {
  constexpr std::uint32_t width = width_of<Real>;
  std::size_t links = 0;
  for (const PairRun* run = runs; run < runs + count; ++run) {
    for (std::uint32_t begin = run->begin; begin < run->end; begin += width) {
      const std::uint32_t rest = run->end - begin;
      const LinkedPairs<Real> pairs(in, *run, begin, static_cast<int>(rest < width ? rest : width));
      if (pairs.near() != 0) {
        pairs.emit(groups, links, pairs.coupling(terms, weights));
      }
    }
  }
  const std::size_t count_of_groups = (links + links_per_group - 1) / links_per_group;
  for (; links < count_of_groups * links_per_group; ++links) {
    LinkGroup& group = groups[links / links_per_group];
    const auto place = static_cast<int>(links % links_per_group);
    group.first[place] = group.second[place] = 0;
    Floats* const numbers[] = {&group.normal[0],   &group.normal[1],   &group.normal[2],   &group.squeeze,
                               &group.shear,       &group.pump_first,  &group.pump_second, &group.twist_first,
                               &group.twist_cross, &group.twist_second};
    for (Floats* const number : numbers) {
      (*number)[place] = 0;
    }
  }
  return count_of_groups;
}

}  // namespace peclet::engine
