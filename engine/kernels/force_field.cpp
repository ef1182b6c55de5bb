#include "engine/kernels/force_field.h"

#include <optional>

#include "engine/kernels/pair_recipes.h"
#include "engine/terms/drag.h"

namespace peclet::engine {

ForceField::ForceField(const Physics& physics, const ParticleState& particles, double timestep,
                       std::uint64_t seed, int threads, InstructionSet set, double approach_time,
                       StepResistance::Part part)
    : physics_(physics),
      terms_(required_terms(physics)),
      kinds_(make_pair_kinds(physics, distinct_radii(particles.radius))),
      pair_pass_(terms_, set),
      parameters_(pair_parameters(physics, timestep)),
      pair_noise_(seed, Purpose::pair_noise),
      one_body_noise_(seed, Purpose::one_body_noise),
      fill_normals_(engine::fill_normals(set)),
      one_body_(one_body_kernels(set)),
      link_(link_kernels(set)),
      threads_(threads) {
  parameters_.approach_time = approach_time;
  parameters_.step_resistance = {part, timestep};
  for (const double radius : distinct_radii(particles.radius)) {
    const double zeta = translational_drag(physics.viscosity, radius);
    const double zeta_r = rotational_drag(physics.viscosity, radius);
    drag_.push_back({zeta, zeta_r});
    drag_noise_.push_back({drag_noise_amplitude(parameters_.noise_amplitude, zeta),
                           drag_noise_amplitude(parameters_.noise_amplitude, zeta_r)});
  }
}

PairSums ForceField::evaluate(System& system, VectorField& force, VectorField& torque) {
  const PairSums sums = evaluate_blocks(system, force, torque);
  add_incoming(system, force, torque);
  return sums;
}

PairPassInput ForceField::pair_input(const System& system) const {
  return {
      .particles = system.particles,
      .list = system.list,
      .box = system.box,
      .kinds = kinds_,
      .parameters = parameters_,
      .noise = pair_noise_.key(system.step, system.part),
      .varying = feels_varying_flow(physics_) ? &varying_ : nullptr,
      .threads = threads_,
  };
}

void ForceField::show_pairs(const System& system, SpringField springs, bool advanced, double weight,
                            PairWatcher& watcher) {
  PairPassInput input = pair_input(system);
  if (advanced) input.parameters.spring_timestep = 0;
  watcher.begin(system, weight);
  pair_pass_.each_pair(input, springs, [&](const Pair& pair, const PairSums& sums, const Vector3& force) {
    watcher.take(system, pair, sums, force);
  });
}

bool ForceField::leaves_loads_with_links() const {
  const bool tangent_is_secant = parameters_.step_resistance.part != StepResistance::Part::on_the_way;
  return tangent_is_secant && !terms_.friction && !terms_.damping && !terms_.strained && !terms_.noise &&
         physics_.thermal_energy == 0 && !physics_.flow.varies();
}

ForceField::AssembleLinks ForceField::assemble_links(System& system, const LinkWeights& weights,
                                                     LinkOrder& order, std::vector<LinkGroup>& groups,
                                                     const LoadRows* loads) {
  const std::size_t room = order.inner_groups() + order.crossing_groups();
  groups.resize(std::max(groups.size(), room));
  std::optional<OneBodyInput> one_body;
  if (loads != nullptr) {
    one_body = one_body_input(system, loads->force, loads->torque);
    linked_sums_.resize(order.blocks().size());
  }
  return [this, &list = system.list, &order, weights, places = order.places(), groups = groups.data(),
          one_body, sums = linked_sums_.data(), crossing = pair_pass_.crossing_rows(system.list),
          input = pair_pass_.kernel_input(pair_input(system), system.springs)](std::size_t number) {
    const ParticleBlock& block = list.blocks()[number];
    std::optional<PairKernelOutput> output;
    if (one_body) {
      one_body_.set_drag(*one_body, block.begin, block.end);
      const std::size_t offset = 4 * std::size_t{block.begin};
      output = {block.begin, one_body->force + offset, one_body->torque + offset, crossing, sums + number};
    }
    link_.assemble(input, list.runs().data() + block.runs_begin, block.runs_end - block.runs_begin, terms_,
                   weights, places, order.blocks()[number], groups, output ? &*output : nullptr);
  };
}

OneBodyInput ForceField::one_body_input(System& system, VectorField& force, VectorField& torque,
                                        const OneBodyFactors* kicks) const {
  ParticleState& particles = system.particles;
  return {.position = particles.position.data(),
          .velocity = particles.velocity.data(),
          .spin = particles.angular_velocity.data(),
          .force = force.data(),
          .torque = torque.data(),
          .size_class = particles.size_class.data(),
          .kicks = kicks,
          .drag = drag_.data(),
          .flow = plain_flow(system.box.velocity_gradient())};
}

PairSums ForceField::evaluate_blocks(System& system, VectorField& force, VectorField& torque) {
  const OneBodyInput one_body = one_body_input(system, force, torque);
  return evaluate_blocks(system, force, torque, [&](const ParticleBlock& block) {
    one_body_.set_drag(one_body, block.begin, block.end);
  });
}

PairSums ForceField::evaluate_blocks(System& system, VectorField& force, VectorField& torque,
                                     const SetDrag& set_drag) {
  return add_pairs(system, force, torque, [&](const ParticleBlock& block) {
    set_drag(block);
    if (physics_.flow.varies()) add_varying_drag(system, block.begin, block.end, force, torque);
    if (physics_.thermal_energy > 0) add_drag_noise(system, block.begin, block.end, force, torque);
  });
}

PairSums ForceField::evaluate_pairs(System& system, VectorField& force, VectorField& torque) {
  const PairSums sums =
      add_pairs(system, force, torque, [&](const ParticleBlock& block) { clear_rows(block, force, torque); });
  add_incoming(system, force, torque);
  return sums;
}

// Adds the loads of pairs to rows that `set_rows` sets. Crossing pairs need the non-uniform flow in other
// blocks: it is set for all particles first, or block by block on one thread, where blocks may move in turn.
PairSums ForceField::add_pairs(System& system, VectorField& force, VectorField& torque,
                               const SetDrag& set_rows) {
  const bool feels_varying = feels_varying_flow(physics_), in_turn = threads_ <= 1;
  if (feels_varying && varying_.size() != system.particles.count()) {
    varying_ = FlowAtCentres(system.particles.count(), threads_);
  }
  if (feels_varying && !in_turn) {
    for_each_range(system.particles.count(), threads_,
                   [&](std::size_t begin, std::size_t end) { set_varying_flow(system, begin, end); });
  }
  return pair_pass_.add_pairs(pair_input(system), system.springs, force, torque,
                              [&](const ParticleBlock& block) {
                                set_rows(block);
                                if (feels_varying && in_turn) {
                                  set_varying_flow(system, block.begin, block.end);
                                }
                              });
}

PairKernelInput ForceField::input_of_change(System& system, const Motion& before) {
  PairKernelInput kernel = pair_pass_.kernel_input(pair_input(system), system.springs);
  kernel.velocity = before.velocity.data();
  kernel.spin = before.spin.data();
  return kernel;
}

void ForceField::each_pair(const System& system, SpringField springs, const PairPass::VisitPair& visit) {
  pair_pass_.each_pair(pair_input(system), springs, visit);
}

void ForceField::each_change(System& system, const LinkWeights& weights, const Motion& before,
                             const Motion& change, const PairPass::VisitPair& visit) {
  const PairKernelInput kernel = input_of_change(system, before);
  PairPass::each_pair(
      system.list,
      [&](const PairRun& pair, const PairKernelOutput& out) {
        link_.leave_change(kernel, &pair, 1, terms_, weights, {change.velocity.data(), change.spin.data()},
                           out);
      },
      visit);
}

PairSums ForceField::evaluate_change(System& system, const LinkWeights& weights, const Motion& before,
                                     const Motion& change, VectorField& force, VectorField& torque) {
  const std::vector<ParticleBlock>& blocks = system.list.blocks();
  const PairKernelInput kernel = input_of_change(system, before);
  double* const crossing = pair_pass_.crossing_rows(system.list);
  linked_sums_.resize(blocks.size());
  for_each_range(blocks.size(), threads_, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      const ParticleBlock& block = blocks[b];
      const std::size_t offset = 4 * std::size_t{block.begin};
      clear_rows(block, force, torque);
      link_.leave_change(
          kernel, system.list.runs().data() + block.runs_begin, block.runs_end - block.runs_begin, terms_,
          weights, {change.velocity.data(), change.spin.data()},
          {block.begin, force.data() + offset, torque.data() + offset, crossing, &linked_sums_[b]});
    }
  });
  add_incoming(system, force, torque);
  return total_of(linked_sums_);
}

void ForceField::set_varying_flow(const System& system, std::size_t begin, std::size_t end) {
  varying_.set(physics_.flow.at(system.box), system.particles, begin, end);
}

void ForceField::add_varying_drag(const System& system, std::size_t begin, std::size_t end,
                                  VectorField& force, VectorField& torque) const {
  const ParticleState& particles = system.particles;
  const BackgroundFlow flow = physics_.flow.at(system.box);
  for (std::size_t i = begin; i < end; ++i) {
    const OneBodyFactors& drag = drag_[particles.size_class[i]];
    const Vector3 x = particles.position[i];
    const auto [velocity, spin] = flow.varying_motion(x, particles.radius[i]);
    force.add(i, drag.translational * velocity);
    torque.add(i, drag.rotational * spin);
  }
}

void ForceField::add_drag_noise(const System& system, std::size_t begin, std::size_t end, VectorField& force,
                                VectorField& torque) const {
  const NoiseKey key = one_body_noise_.key(system.step, system.part);
  std::uint64_t identity[identities_per_block] = {};
  NormalBlock normals;
  for (std::size_t first = begin; first < end; first += identities_per_block) {
    const std::size_t count = std::min<std::size_t>(identities_per_block, end - first);
    for (std::size_t k = 0; k < count; ++k) identity[k] = system.particles.id[first + k];
    fill_normals_(key, identity, nullptr, normals);
    for (std::size_t k = 0; k < count; ++k) {
      const auto normal = [&](int c) { return static_cast<double>(normals.value[c][k]); };
      add_drag_noise(system, first + k,
                     {{normal(0), normal(1), normal(2)}, {normal(3), normal(4), normal(5)}}, force, torque);
    }
  }
}

}  // namespace peclet::engine
