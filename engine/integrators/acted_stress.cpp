#include "engine/integrators/acted_stress.h"

#include "engine/state/eigen_arrays.h"
#include "engine/terms/drag.h"

namespace peclet::engine {
namespace {

void add_stress(PairSums& sums, const PairSums& more) {
  for (std::size_t t = 0; t < count_of_stress_terms; ++t) sums.stress[t] += more.stress[t];
}

std::size_t number_of(const System& system, const Pair& pair) {
  return static_cast<std::size_t>(&pair - system.list.pairs().data());
}

}  // namespace

void ActedStress::begin(const PairSums& sums, const VectorField& force) {
  sums_ = sums;
  force_at_beginning_ = force;
}

void ActedStress::predict(const System& system, const PairSums& sums, const Loads& loads,
                          const Physics& physics) {
  const ParticleState& particles = system.particles;
  add_stress(sums_, sums);
  sums_.contacts = sums.contacts;
  sums_.overlaps = sums.overlaps;
  sums_.largest_overlap = sums.largest_overlap;
  sums_.finite = sums_.finite && sums.finite;
  const BackgroundFlow flow = physics.flow.at(system.box);
  force_ahead_ = loads.force;
  for (std::size_t i = 0; i < particles.count(); ++i) {
    const double radius = particles.radius[i];
    force_ahead_.add(i, translational_drag(physics.viscosity, radius) *
                            (particles.velocity[i] - flow.velocity(particles.position[i], radius)));
  }
  predicted_.velocity = particles.velocity;
  predicted_.spin = particles.angular_velocity;
}

PairSums ActedStress::end(System& system, ForceField& field, const LinkWeights& weights, double timestep) {
  const ParticleState& particles = system.particles;
  change_.velocity = particles.velocity;
  array(change_.velocity) -= array(predicted_.velocity);
  change_.spin = particles.angular_velocity;
  array(change_.spin) -= array(predicted_.spin);
  if (force_of_change_.size() != particles.count()) {
    force_of_change_ = torque_of_change_ = VectorField(particles.count(), field.threads());
  }
  const PairSums change =
      field.evaluate_change(system, weights, predicted_, change_, force_of_change_, torque_of_change_);
  add_stress(sums_, change);
  const double half = 0.5 * timestep;
  sums_.of(carried_term(field.physics())) += sum_over_particles(system, field.threads(), [&](std::size_t i) {
    const Vector3 way = half * relative_to_flow(system, i, particles.velocity[i]);
    return -1.0 * (symmetric_dyad(way, force_at_beginning_[i]) +
                   symmetric_dyad(half * change_.velocity[i], force_ahead_[i] + force_of_change_[i]));
  });
  return sums_;
}

void ActedStress::begin_pairs(const System& system, ForceField& field) {
  pairs_.assign(system.list.pairs().size(), {});
  field.each_pair(system, {}, [&](const Pair& pair, const PairSums& sums, const Vector3& force) {
    OfPair& own = pairs_[number_of(system, pair)];
    own.sums = sums;
    own.force_at_beginning = force;
  });
}

void ActedStress::predict_pairs(const System& system, ForceField& field) {
  field.each_pair(system, system.springs, [&](const Pair& pair, const PairSums& sums, const Vector3& force) {
    OfPair& own = pairs_[number_of(system, pair)];
    add_stress(own.sums, sums);
    own.force_ahead = force;
  });
}

void ActedStress::end_pairs(System& system, ForceField& field, const LinkWeights& weights, double timestep) {
  const ParticleState& particles = system.particles;
  const auto peculiar = [&](std::size_t i) { return relative_to_flow(system, i, particles.velocity[i]); };
  field.each_change(
      system, weights, predicted_, change_,
      [&](const Pair& pair, const PairSums& sums, const Vector3& force) {
        OfPair& own = pairs_[number_of(system, pair)];
        add_stress(own.sums, sums);
        own.force_ahead += force;
        const Vector3 way = peculiar(pair.second) - peculiar(pair.first),
                      change = change_.velocity[pair.second] - change_.velocity[pair.first];
        own.sums.of(carried_term(field.physics())) +=
            0.5 * timestep *
            (symmetric_dyad(way, own.force_at_beginning) + symmetric_dyad(change, own.force_ahead));
      });
}

void ActedStress::show_pairs(const System& system, PairWatcher& watcher) const {
  for (std::size_t p = 0; p < pairs_.size(); ++p) {
    const OfPair& own = pairs_[p];
    watcher.take(system, system.list.pairs()[p], own.sums, own.force_at_beginning + own.force_ahead);
  }
}

}  // namespace peclet::engine
