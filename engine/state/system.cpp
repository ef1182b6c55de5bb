#include "engine/state/system.h"

#include "engine/state/particle_order.h"

namespace peclet::engine {

void rebuild_neighbours(System& system, int threads) {
  ParticleState& particles = system.particles;
  std::vector<HeldContact> held = held_contacts(system.list, particles, system.springs, threads);
  if (system.list.can_narrow(particles, system.box, threads)) {
    system.list.narrow(particles, system.box, threads);
    system.springs = placed_contacts(system.list, particles, held, system.springs.kinds(), threads);
    return;
  }
  if (const BasisChange change = system.box.due_change(); change != BasisChange{}) {
    system.box.change_basis(change);
    for (LatticeShift& image : particles.image) {
      image = change.after(image);
    }
    for (HeldContact& contact : held) {
      contact.image = change.after(contact.image);
    }
  }
  wrap_into_cell(particles, system.box);
  arrange_along_curve(particles, system.box, threads);
  system.list.build(particles, system.box, threads);
  system.springs = placed_contacts(system.list, particles, held, system.springs.kinds(), threads);
}

void save(const System& system, ArchiveWriter& archive) {
  const ParticleState& particles = system.particles;
  archive.put(system.step);
  archive.put(system.clock);
  archive.put(system.box.displacement_gradient());
  archive.put(system.box.velocity_gradient());
  archive.put(system.box.basis());
  archive.put(particles.id);
  for (const VectorField* field : {&particles.position, &particles.velocity, &particles.angular_velocity}) {
    archive.put(*field);
  }
  archive.put(particles.image);
  for (const ListMoment* moment : {&system.list.moment_of_candidates(), &system.list.listed()}) {
    archive.put(moment->position);
    archive.put(moment->displacement_gradient);
  }
  archive.put(system.list.builds());
  for (std::size_t c = 0; c < system.springs.components(); ++c) {
    archive.put(system.springs.values(c));
  }
}

void load(System& system, ArchiveReader& archive) {
  ParticleState& particles = system.particles;
  const std::size_t count = particles.count();
  system.step = archive.get<std::uint64_t>();
  system.clock = archive.get<Clock>();
  const auto displacement_gradient = archive.get<Matrix3>();
  system.box.set_velocity_gradient(archive.get<Matrix3>());
  system.box.set_basis(archive.get<BasisChange>());
  arrange_by_id(particles, archive.get_vector<std::uint32_t>(count));
  for (VectorField* field : {&particles.position, &particles.velocity, &particles.angular_velocity}) {
    *field = archive.get_field(count);
  }
  particles.image = archive.get_vector<LatticeShift>(count);
  const auto moment = [&] {
    VectorField position = archive.get_field(count);
    return ListMoment{std::move(position), archive.get<Matrix3>()};
  };
  ListMoment candidates = moment(), listed = moment();
  const auto builds = archive.get<std::uint64_t>();
  // A change of basis always comes with a build, so the basis is still that of the build.
  system.list.rebuild_from(std::move(candidates), std::move(listed), particles, system.box);
  system.list.set_builds(builds);
  system.box.deform(displacement_gradient);
  system.springs = SpringField(system.springs.kinds(), system.list.pairs().size());
  for (std::size_t c = 0; c < system.springs.components(); ++c) {
    system.springs.set_values(c, archive.get_vector<double>(system.list.pairs().size()));
  }
}

}  // namespace peclet::engine
