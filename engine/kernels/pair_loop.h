// The pair loop itself, compiled once for each recipe.
#pragma once

#include "engine/kernels/for_each_range.h"
#include "engine/kernels/pair_pass.h"

namespace peclet::engine {

constexpr std::size_t pairs_per_chunk = 256;

template <Terms terms>
PairSums sum_chunk(const PairPassInput& in, PairPassWork& work, ContactSprings* springs, std::size_t begin,
                   std::size_t end) {
  PairSums sums;
  const auto add = [&sums](StressTerm term, const Vector3& r, const Vector3& force) {
    sums.stress[static_cast<std::size_t>(term)] += symmetric_dyad(r, force);
  };
  const std::vector<Pair>& pairs = in.list.pairs();
  for (std::size_t p = begin; p < end; ++p) {
    const Pair& pair = pairs[p];
    const PairKind& kind = in.kinds[pair.kind];
    const ImageFrame& frame = work.frames[pair.image];
    const Vector3 r = separation(in.particles, pair, frame);
    const double squared = dot(r, r);
    if (!(squared <= kind.range * kind.range)) {
      sums.finite = sums.finite && std::isfinite(squared);
      work.loads[p] = {};
      if constexpr (terms.friction) {
        springs[p] = {};
      }
      continue;
    }
    const PairGeometry shape = geometry(r, kind);
    const TermLoads loads = pair_terms<terms>(
        in.parameters, kind, shape, motion(in.particles, pair, frame), terms.friction ? springs + p : nullptr,
        [&] { return in.random.normals(in.step, pair.first, pair.second, in.list.images()[pair.image]); });
    PairLoad total;
    if constexpr (terms.lubrication) {
      total += loads.lubrication;
      add(StressTerm::lubrication, r, loads.lubrication.force);
    }
    if constexpr (terms.noise) {
      total += loads.noise;
      add(StressTerm::brownian_lubrication, r, loads.noise.force);
    }
    if constexpr (terms.repulsion) {
      total.force += loads.repulsion;
      add(StressTerm::repulsion, r, loads.repulsion);
    }
    if constexpr (terms.contact) {
      if (shape.overlap() > 0) {
        total.force += loads.contact_normal;
        add(StressTerm::contact_normal, r, loads.contact_normal);
        ++sums.contacts;
        sums.largest_overlap = std::max(sums.largest_overlap, shape.overlap() / kind.smaller_radius);
        if constexpr (terms.damping) {
          total.force += loads.contact_damping;
          add(StressTerm::contact_damping, r, loads.contact_damping);
        }
        if constexpr (terms.friction) {
          total += loads.friction;
          add(StressTerm::friction, r, loads.friction.force);
        }
        if constexpr (terms.rolling) {
          total += loads.rolling;
        }
      }
    }
    work.loads[p] = total;
  }
  return sums;
}

// Sums each particle's loads in the order of the list.
void gather_loads(const NeighbourList& list, const std::vector<PairLoad>& loads, int threads,
                  VectorField& force, VectorField& torque);

template <Terms terms>
PairSums run_pair_pass(const PairPassInput& in, PairPassWork& work, std::vector<ContactSprings>& springs,
                       VectorField& force, VectorField& torque) {
  const std::size_t count = in.list.pairs().size();
  const std::size_t chunks = (count + pairs_per_chunk - 1) / pairs_per_chunk;
  work.frames = image_frames(in.list, in.box);
  work.loads.resize(count);
  work.chunks.resize(chunks);
  for_each_range(chunks, in.threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c) {
      work.chunks[c] = sum_chunk<terms>(in, work, springs.data(), c * pairs_per_chunk,
                                        std::min(count, (c + 1) * pairs_per_chunk));
    }
  });
  gather_loads(in.list, work.loads, in.threads, force, torque);
  PairSums total;
  for (const PairSums& chunk : work.chunks) {
    total += chunk;
  }
  return total;
}

}  // namespace peclet::engine
