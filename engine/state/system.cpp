#include "engine/state/system.h"

#include "engine/state/particle_order.h"

namespace peclet::engine {

void rebuild_neighbours(System& system, int threads) {
  ParticleState& particles = system.particles;
  std::vector<HeldContact> held = held_contacts(system.list, particles, system.springs);
  if (const std::int32_t flips = system.box.due_flips(); flips != 0) {
    system.box.flip(flips);
    for (LatticeShift& image : particles.image) {
      image = ShearedBox::rebased(image, flips);
    }
    for (HeldContact& contact : held) {
      contact.image = ShearedBox::rebased(contact.image, flips);
    }
  }
  wrap_into_cell(particles, system.box);
  arrange_along_curve(particles, system.box, threads);
  system.list.build(particles, system.box, threads);
  system.springs = placed_contacts(system.list, particles, held, system.springs.kinds());
}

void save(const System& system, ArchiveWriter& archive) {
  const ParticleState& particles = system.particles;
  archive.put(system.step);
  archive.put(system.box.strain());
  archive.put(system.box.flips());
  archive.put(particles.id);
  for (const VectorField* field : {&particles.position, &particles.velocity, &particles.angular_velocity}) {
    archive.put(*field);
  }
  archive.put(particles.image);
  archive.put(system.list.reference());
  archive.put(system.list.strain_at_build());
  archive.put(system.list.builds());
  for (std::size_t c = 0; c < system.springs.components(); ++c) {
    archive.put(system.springs.values(c));
  }
}

void load(System& system, ArchiveReader& archive) {
  ParticleState& particles = system.particles;
  const std::size_t count = particles.count();
  system.step = archive.get<std::uint64_t>();
  const auto strain = archive.get<double>();
  const auto flips = archive.get<std::int32_t>();
  arrange_by_id(particles, archive.get_vector<std::uint32_t>(count));
  for (VectorField* field : {&particles.position, &particles.velocity, &particles.angular_velocity}) {
    *field = archive.get_field(count);
  }
  particles.image = archive.get_vector<LatticeShift>(count);
  VectorField reference = archive.get_field(count);
  const auto strain_at_build = archive.get<double>();
  const auto builds = archive.get<std::uint64_t>();
  // A flip always comes with a build, so the basis is still that of the build.
  system.box.place(strain_at_build, flips);
  system.list.rebuild_from(std::move(reference), particles, system.box);
  system.list.set_builds(builds);
  system.box.place(strain, flips);
  system.springs = SpringField(system.springs.kinds(), system.list.pairs().size());
  for (std::size_t c = 0; c < system.springs.components(); ++c) {
    system.springs.set_values(c, archive.get_vector<double>(system.list.pairs().size()));
  }
}

}  // namespace peclet::engine
