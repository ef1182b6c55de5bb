#include "engine/state/system.h"

namespace peclet::engine {

void rebuild_neighbours(System& system) {
  ParticleState& particles = system.particles;
  std::vector<HeldContact> held = held_contacts(system.list, particles.image, system.springs);
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
  system.list.build(particles, system.box);
  system.springs = placed_contacts(system.list, particles.image, held);
}

void save(const System& system, ArchiveWriter& archive) {
  const ParticleState& particles = system.particles;
  archive.put(system.step);
  archive.put(system.box.strain());
  archive.put(system.box.flips());
  for (const VectorField* field : {&particles.position, &particles.velocity, &particles.angular_velocity}) {
    archive.put(*field);
  }
  archive.put(particles.image);
  archive.put(system.list.reference());
  archive.put(system.list.strain_at_build());
  archive.put(system.list.builds());
  archive.put(system.springs);
}

void load(System& system, ArchiveReader& archive) {
  ParticleState& particles = system.particles;
  const std::size_t count = particles.count();
  system.step = archive.get<std::uint64_t>();
  const auto strain = archive.get<double>();
  const auto flips = archive.get<std::int32_t>();
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
  system.springs = archive.get_vector<ContactSprings>(system.list.pairs().size());
}

}  // namespace peclet::engine
