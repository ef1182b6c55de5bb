#include "tests/bench/engine/operations.h"

#include "engine/kernels/pair_kernel.h"
#include "engine/kernels/pair_recipes.h"

namespace peclet::engine {

thread_local Operations Counted::done;

namespace {

struct CountingKernel {
  Terms terms;
  PairKernel kernel;
};

template <Terms terms>
constexpr CountingKernel counting() {
  return {terms, &run_pair_kernel<Counted, terms>};
}

constexpr CountingKernel counting_kernels[] = {
    counting<Terms{.lubrication = true, .contact = true}>(),
    counting<Terms{.lubrication = true, .contact = true, .friction = true}>(),
    counting<Terms{.lubrication = true, .noise = true, .contact = true}>(),
    counting<Terms{.lubrication = true, .noise = true, .contact = true, .friction = true}>(),
};

}  // namespace

std::optional<Operations> count_operations(const Physics& physics, System system, double timestep) {
  const Terms terms = required_terms(physics);
  for (const CountingKernel& candidate : counting_kernels) {
    if (candidate.terms == terms) {
      const std::vector<PairKind> kinds = make_pair_kinds(physics, distinct_radii(system.particles.radius));
      VectorField force(system.particles.count()), torque(system.particles.count());
      Counted::done = {};
      PairPass(terms, candidate.kernel, fill_normals(InstructionSet::baseline))
          .evaluate({.particles = system.particles,
                     .list = system.list,
                     .box = system.box,
                     .kinds = kinds,
                     .parameters = pair_parameters(physics, timestep),
                     .noise = {}},
                    system.springs, force, torque);
      return Counted::done;
    }
  }
  return std::nullopt;
}

double bytes_per_particle(const Physics& physics, const System& system, int threads) {
  constexpr double row = 32, fetched_and_written = 2 * row;
  const Terms terms = required_terms(physics);
  const auto count = static_cast<double>(system.particles.count());
  const double pairs = static_cast<double>(system.list.pairs().size()) / count;
  const double crossings = static_cast<double>(system.list.crossings()) / count;
  double bytes = 0;
  if (threads == 1 && !terms.friction) {
    // A single loop reads the state, forces and torques and writes them back.
    bytes += 10 * row + sizeof(std::uint16_t);
  } else {
    // Kick and drift read forces, torques and the whole state, and write the state back.
    bytes += 8 * row + sizeof(std::uint16_t);
    // Pairs, drag and noise read the state and overwrite forces and torques.
    bytes += 3 * row + 2 * fetched_and_written + sizeof(std::uint16_t);
  }
  bytes += terms.noise ? sizeof(std::uint32_t) : 0;
  bytes += pairs * sizeof(Pair);
  bytes += 2 * pairs * static_cast<double>(system.springs.components() * sizeof(double));
  // Force and torque of a crossing pair are stored aside, then fetched by the other block.
  bytes += crossings * (2 * fetched_and_written + 2 * row + sizeof(IncomingPair));
  return bytes;
}

}  // namespace peclet::engine
