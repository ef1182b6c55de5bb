#include "engine/state/system.h"

#include <algorithm>
#include <cmath>

#include "engine/state/particles.h"

namespace peclet::engine {
namespace {

// Throws ArchiveError unless the cell has a volume, few images of it lie within `range`, and the cells
// between spheres can be counted. Neighbour lists require all three. No sphere of a run meets its own image,
// so its cell is at least about as wide as the range.
void require_places(const VectorField& position, const PeriodicCell& box, double range) {
  constexpr double most_cells = 1e6, most_images = 8;
  const CellFrame cell = box.frame();
  const auto is_length = [](double x) { return x >= 1e-100 && x <= 1e100; };
  const Vector3 widths = cell.widths();
  const auto is_near = [](double x) { return std::abs(x) <= most_cells; };
  bool is_good = is_length(cell.lengths.x) && is_length(cell.lengths.y) && is_length(cell.lengths.z) &&
                 is_near(cell.tilt_xy / cell.lengths.x) && is_near(cell.xz / cell.lengths.x) &&
                 is_near(cell.yz / cell.lengths.y) &&
                 range < most_images * std::min({widths.x, widths.y, widths.z});
  for (std::size_t i = 0; is_good && i < position.size(); ++i) {
    const Vector3 cells = cell.fractional(position[i]);
    is_good = is_near(cells.x) && is_near(cells.y) && is_near(cells.z);
  }
  if (is_good) return;
  throw ArchiveError(
      "has a cell that has no volume or is too thin for its spheres, or a sphere far outside its cell");
}

}  // namespace

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
    for (LatticeShift& image : particles.image) image = change.after(image);
    for (HeldContact& contact : held) contact.image = change.after(contact.image);
  }
  wrap_into_cell(particles, system.box);
  arrange_along_curve(particles, system.box, threads);
  system.list.build(particles, system.box, threads);
  system.springs = placed_contacts(system.list, particles, held, system.springs.kinds(), threads);
}

void save(const System& system, ArchiveWriter& archive) {
  const ParticleState& particles = system.particles;
  const PeriodicCell& box = system.box;
  archive.put_all(system.step, system.clock, box.displacement_gradient(), box.velocity_gradient(),
                  box.basis(), particles.id, particles.position, particles.velocity,
                  particles.angular_velocity, particles.image);
  for (const ListMoment* moment : {&system.list.moment_of_candidates(), &system.list.listed()}) {
    archive.put_all(moment->position, moment->displacement_gradient);
  }
  archive.put(system.list.builds());
  for (std::size_t c = 0; c < system.springs.components(); ++c) archive.put(system.springs.values(c));
}

void load(System& system, ArchiveReader& archive) {
  ParticleState& particles = system.particles;
  const std::size_t count = particles.count();
  Matrix3 displacement_gradient, velocity_gradient;
  BasisChange basis;
  std::vector<std::uint32_t> id(count);
  archive.get_all(system.step, system.clock, displacement_gradient, velocity_gradient, basis, id);
  system.box.set_velocity_gradient(velocity_gradient);
  system.box.set_basis(basis);
  arrange_by_id(particles, id);
  archive.get_all(particles.position, particles.velocity, particles.angular_velocity, particles.image);
  ListMoment candidates{VectorField(count), {}}, listed = candidates;
  std::uint64_t builds = 0;
  archive.get_all(candidates.position, candidates.displacement_gradient, listed.position,
                  listed.displacement_gradient, builds);
  const auto require = [&](const VectorField& position, const Matrix3& gradient) {
    PeriodicCell box = system.box;
    box.deform(gradient);
    require_places(position, box, system.list.ranges().largest());
  };
  require(particles.position, displacement_gradient);
  require(candidates.position, candidates.displacement_gradient);
  require(listed.position, listed.displacement_gradient);
  // A change of basis always comes with a build, so the basis is still that of the build.
  system.list.rebuild_from(std::move(candidates), std::move(listed), particles, system.box);
  system.list.set_builds(builds);
  system.box.deform(displacement_gradient);
  const std::size_t pairs = system.list.pairs().size();
  system.springs = SpringField(system.springs.kinds(), pairs);
  for (std::size_t c = 0; c < system.springs.components(); ++c) {
    system.springs.set_values(c, archive.get_vector<double>(pairs));
  }
}

}  // namespace peclet::engine
