#include "engine/card/card_setup.h"

#include "engine/integrators/midpoint.h"
#include "engine/integrators/noisy_midpoint.h"
#include "engine/kernels/pair_recipes.h"
#include "engine/terms/drag.h"

namespace peclet::engine {

std::size_t share_out(std::byte* memory, std::size_t particles, CardRealisation& own) {
  CardParts parts(memory);
  for (CardRow** rows : {&own.position, &own.velocity, &own.spin, &own.listed, &own.found,
                         &own.velocity_change, &own.spin_change, &own.begin_position, &own.begin_velocity,
                         &own.begin_spin, &own.force, &own.torque, &own.noise_force, &own.noise_torque,
                         &own.pair_noise, &own.predicted_velocity, &own.predicted_spin, &own.force_ahead}) {
    parts.take(*rows, particles);
  }
  parts.take(own.image, particles);
  for (std::uint32_t** numbers :
       {&own.candidate_count, &own.pair_begin, &own.end_begin, &own.row_count, &own.linked_count}) {
    parts.take(*numbers, particles + 1);
  }
  parts.take(own.order, particles);
  parts.take(own.candidate, particles * own.room.neighbours);
  parts.take(own.pair_of, particles * own.room.neighbours);
  parts.take(own.pair, own.room.pairs);
  parts.take(own.key, own.room.pairs);
  parts.take(own.end, 2 * std::size_t{own.room.pairs});
  parts.take(own.linked_end, 2 * std::size_t{own.room.pairs});
  for (CardRow** rows : {&own.pair_force, &own.torque_first, &own.torque_second})
    parts.take(*rows, own.room.pairs);
  for (double** springs : {&own.springs, &own.springs_after}) {
    parts.take(*springs, components_of_card_springs * own.room.pairs);
  }
  parts.take(own.link, own.room.pairs);
  parts.take(own.twist, own.room.pairs);
  for (CardMotion** rows : {&own.solution, &own.residual, &own.motion}) parts.take(*rows, particles);
  parts.take(own.solver_rows, particles);
  parts.take(own.inverse, block_entries * particles);
  parts.take(own.blocks, card_blocks);
  parts.take(own.step_sums, count_of_card_sums);
  return parts.used();
}

std::vector<CardRow> rows_of(const VectorField& field) {
  std::vector<CardRow> rows(field.size());
  for (std::size_t i = 0; i < field.size(); ++i) rows[i] = {field[i].x, field[i].y, field[i].z, 0};
  return rows;
}

CardPair card_pair(const Pair& pair, const LatticeShift& image) {
  return {pair.first,
          pair.second,
          {static_cast<std::int8_t>(image.x), static_cast<std::int8_t>(image.y),
           static_cast<std::int8_t>(image.z), 0}};
}

std::array<double, components_of_card_springs> card_components(const ContactSprings& springs) {
  const auto& [sliding, rolling, slides] = springs;
  return {sliding.x, sliding.y, sliding.z, rolling.x, rolling.y, rolling.z, slides};
}

std::vector<CardSize> card_sizes(const Physics& physics, const ParticleState& particles) {
  std::vector<CardSize> sizes(distinct_radii(particles.radius).size());
  for (std::size_t i = 0; i < particles.count(); ++i) {
    const double radius = particles.radius[i];
    sizes[particles.size_class[i]] = {radius, particles.mass[i], particles.inertia[i],
                                      translational_drag(physics.viscosity, radius),
                                      rotational_drag(physics.viscosity, radius)};
  }
  return sizes;
}

CardVariant card_variant_of(const Physics& physics) {
  const Terms terms = required_terms(physics);
  using Springs = CardVariant::Springs;
  const Springs springs = !terms.friction ? Springs::none
                          : terms.rolling ? Springs::sliding_and_rolling
                                          : Springs::sliding;
  return {springs, terms.strained, physics.thermal_energy > 0};
}

PairParameters card_parameters(const Physics& physics, double timestep) {
  PairParameters parameters = pair_parameters(physics, timestep);
  const Matrix3 gradient = physics.flow.deformation().velocity_gradient(0);
  parameters.flow = {false, spin_of(gradient), strain_of(gradient)};
  // Kernels with friction remember whether contacts slide.
  ContactParameters& contact = parameters.contact;
  if (!remembers_sliding(contact)) contact.kinetic_friction = contact.friction;
  return parameters;
}

CardLevel card_level(const Physics& physics, const ParticleState& particles, double timestep) {
  constexpr double felt_share = Midpoint::felt_share;
  const bool noisy = physics.thermal_energy > 0;
  CardLevel level{};
  level.timestep = timestep;
  level.inertial = noisy && carried_by_inertia(physics, particles, timestep);
  const PairParameters parameters = card_parameters(physics, timestep);
  level.drag_noise = parameters.noise_amplitude;
  using Part = StepResistance::Part;
  const auto set = [&](CardField field, Part part) -> PairParameters& {
    PairParameters& own = level.field[static_cast<std::size_t>(field)] = parameters;
    own.step_resistance = {part, timestep};
    return own;
  };
  if (!noisy) {
    set(CardField::whole, Part::on_the_way).felt_share = felt_share;
    return level;
  }
  set(CardField::whole, Part::whole);
  set(CardField::at_beginning, level.inertial ? Part::at_beginning : Part::whole).approach_time =
      0.5 * timestep;
  set(CardField::ahead, level.inertial ? Part::ahead : Part::whole);
  set(CardField::with_noise, level.inertial ? Part::jump : Part::none);
  return level;
}

}  // namespace peclet::engine
