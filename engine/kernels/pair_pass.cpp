#include "engine/kernels/pair_pass.h"

#include <algorithm>
#include <stdexcept>

#include "engine/state/threads.h"

namespace peclet::engine {

PairSums total_of(const std::vector<PairSums>& blocks) {
  PairSums total;
  for (const PairSums& block : blocks) {
    for (std::size_t t = 0; t < count_of_stress_terms; ++t) total.stress[t] += block.stress[t];
    total.contacts += block.contacts;
    total.overlaps += block.overlaps;
    total.largest_overlap = std::max(total.largest_overlap, block.largest_overlap);
    total.finite = total.finite && block.finite;
  }
  return total;
}

void clear_rows(const ParticleBlock& block, VectorField& force, VectorField& torque) {
  const std::size_t begin = 4 * std::size_t{block.begin}, count = 4 * std::size_t{block.end - block.begin};
  std::fill_n(force.data() + begin, count, 0.0);
  std::fill_n(torque.data() + begin, count, 0.0);
}

PairParameters pair_parameters(const Physics& physics, double timestep) {
  PairParameters parameters;
  parameters.contact = physics.contact.value_or(ContactParameters{});
  parameters.spring_timestep = timestep;
  parameters.noise_amplitude = timestep > 0 ? std::sqrt(2 * physics.thermal_energy / timestep) : 0;
  return parameters;
}

bool feels_varying_flow(const Physics& physics) {
  return physics.lubrication && physics.lubrication->is_relative_to_flow() && physics.flow.varies();
}

SpringKinds spring_kinds(const Terms& terms) {
  if (!terms.friction) return SpringKinds::none;
  const SpringKinds kinds = terms.rolling ? SpringKinds::tangential_and_rolling : SpringKinds::tangential;
  return terms.kinetic ? that_slide(kinds) : kinds;
}

PairKernelInput PairPass::kernel_input(const PairPassInput& input, SpringField& springs) {
  const std::vector<ImageFrame> frames = image_frames(input.list, input.box);
  if (image_displacement_.size() != frames.size()) {
    image_displacement_ = image_velocity_ = VectorField(frames.size());
  }
  for (std::size_t k = 0; k < frames.size(); ++k) {
    image_displacement_.set(k, frames[k].displacement);
    image_velocity_.set(k, frames[k].velocity);
  }
  image_keys_.clear();
  for (const LatticeShift image : input.list.images()) image_keys_.push_back(image_identity(image));
  static_assert(sizeof(NormalPair) == 6 * sizeof(double));
  PairKernelInput kernel{};
  kernel.position = input.particles.position.data();
  kernel.velocity = input.particles.velocity.data();
  kernel.spin = input.particles.angular_velocity.data();
  kernel.pairs = input.list.pairs().data();
  kernel.image_displacement = image_displacement_.data();
  kernel.image_velocity = image_velocity_.data();
  kernel.kinds = input.kinds.data();
  kernel.parameters = input.parameters;
  if (!damps_) kernel.parameters.contact.normal_damping = 0;
  const Matrix3& gradient = input.box.velocity_gradient();
  kernel.parameters.flow = {input.varying != nullptr, spin_of(gradient), strain_of(gradient)};
  if (input.varying != nullptr) kernel.varying = input.varying->rows();
  for (std::size_t c = 0; c < components_of_springs(springs.kinds()); ++c) {
    kernel.springs[c] = springs.component(c);
  }
  if (remember_sliding(springs.kinds())) kernel.slides = springs.component(springs.components() - 1);
  kernel.noise = input.noise;
  kernel.fill_normals = fill_normals_;
  kernel.id = input.particles.id.data();
  kernel.image_keys = image_keys_.data();
  kernel.given_normals = input.given_noise != nullptr ? &input.given_noise->front().first.x : nullptr;
  return kernel;
}

PairSums PairPass::add_pairs(const PairPassInput& input, SpringField& springs, VectorField& force,
                             VectorField& torque, const SetRows& set_rows) {
  const NeighbourList& list = input.list;
  const bool has_springs = include(springs.kinds(), spring_kinds_) && springs.size() == list.pairs().size();
  if (spring_kinds_ != SpringKinds::none && !has_springs) {
    throw std::invalid_argument("the springs are not those of the list of pairs");
  }
  const std::vector<ParticleBlock>& blocks = list.blocks();
  const PairKernelInput kernel = kernel_input(input, springs);
  double* const crossing = crossing_rows(list);
  sums_.resize(2 * blocks.size());
  for_each_range(blocks.size(), input.threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      const ParticleBlock& block = blocks[b];
      set_rows(block);
      const std::size_t offset = 4 * std::size_t{block.begin};
      kernel_(kernel, list.runs().data() + block.runs_begin, block.runs_end - block.runs_begin,
              {block.begin, force.data() + offset, torque.data() + offset, crossing, &sums_[2 * b]});
    }
  });
  return total_of(sums_);
}

double* PairPass::crossing_rows(const NeighbourList& list) {
  if (crossing_.size() < 2 * list.crossings()) crossing_ = VectorField(2 * list.crossings());
  return crossing_.data();
}

void PairPass::add_incoming(const NeighbourList& list, const ParticleBlock& block, VectorField& force,
                            VectorField& torque) const {
  for (std::uint32_t k = block.incoming_begin; k < block.incoming_end; ++k) {
    // The processor cannot predict the order of these rows.
    const std::size_t ahead = std::min<std::size_t>(k + 16, list.incoming().size() - 1);
    __builtin_prefetch(crossing_.data() + 8 * std::size_t{list.incoming()[ahead].crossing});
    const IncomingPair& pair = list.incoming()[k];
    force.row(pair.particle) += crossing_.row(2 * std::size_t{pair.crossing});
    torque.row(pair.particle) += crossing_.row(2 * std::size_t{pair.crossing} + 1);
  }
}

void PairPass::add_incoming(const NeighbourList& list, int threads, VectorField& force,
                            VectorField& torque) const {
  if (list.crossings() == 0) return;
  for_each_range(list.blocks().size(), threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) add_incoming(list, list.blocks()[b], force, torque);
  });
}

void PairPass::each_pair(const PairPassInput& input, SpringField& springs, const VisitPair& visit) {
  const PairKernelInput kernel = kernel_input(input, springs);
  each_pair(
      input.list, [&](const PairRun& pair, const PairKernelOutput& out) { kernel_(kernel, &pair, 1, out); },
      visit);
}

void PairPass::each_pair(const NeighbourList& list, const ComputePair& compute, const VisitPair& visit) {
  // Own rows: the step may still need crossing_.
  const std::size_t count = list.blocks().empty() ? 0 : list.blocks().back().end;
  VectorField force(count), torque(count), crossing(2 * list.crossings());
  std::vector<PairSums> sums(2);
  for (const ParticleBlock& block : list.blocks()) {
    const std::size_t offset = 4 * std::size_t{block.begin};
    for (std::uint32_t r = block.runs_begin; r < block.runs_end; ++r) {
      PairRun single = list.runs()[r];
      for (std::uint32_t p = list.runs()[r].begin; p < list.runs()[r].end; ++p) {
        single.begin = p;
        single.end = p + 1;
        const Pair& pair = list.pairs()[p];
        const std::uint32_t own = single.first_is_away ? pair.second : pair.first;
        force.set(own, {});
        std::ranges::fill(sums, PairSums{});
        compute(single,
                {block.begin, force.data() + offset, torque.data() + offset, crossing.data(), sums.data()});
        const Vector3 on_own = force[own];
        visit(pair, total_of(sums), single.first_is_away ? -1.0 * on_own : on_own);
        if (single.crossing != within_block) ++single.crossing;
      }
    }
  }
}

PairSums PairPass::evaluate(const PairPassInput& input, SpringField& springs, VectorField& force,
                            VectorField& torque) {
  const PairSums sums = add_pairs(input, springs, force, torque,
                                  [&](const ParticleBlock& block) { clear_rows(block, force, torque); });
  add_incoming(input.list, input.threads, force, torque);
  return sums;
}

}  // namespace peclet::engine
