#include "engine/integrators/spurious_energy.h"

#include "engine/kernels/pair_access.h"
#include "engine/terms/spring_laws.h"

namespace peclet::engine {
namespace {

// HalfStepMotion gives the velocities that the forces were evaluated with.
class HalfStepMotion {
 public:
  HalfStepMotion(const ParticleState& particles, const VectorField& force, const VectorField& torque,
                 double timestep)
      : particles_(particles), force_(force), torque_(torque), half_step_(0.5 * timestep) {}

  PairMotion of(const Pair& pair, const ImageFrame& frame) const {
    return {velocity(pair.second) - velocity(pair.first) + frame.velocity, spin(pair.first),
            spin(pair.second)};
  }

 private:
  Vector3 velocity(std::size_t i) const {
    return particles_.velocity[i] - (half_step_ / particles_.mass[i]) * force_[i];
  }
  Vector3 spin(std::size_t i) const {
    return particles_.angular_velocity[i] - (half_step_ / particles_.inertia[i]) * torque_[i];
  }

  const ParticleState& particles_;
  const VectorField &force_, &torque_;
  double half_step_;
};

// Returns the potential of contact and conservative laws.
Potential potential(const Physics& physics, const PairKind& kind, double distance) {
  Potential sum = engine::potential(kind.conservative, distance, kind.sum_of_radii);
  if (const double overlap = kind.sum_of_radii - distance; physics.contact && overlap > 0) {
    sum.energy += contact_energy(physics.contact->normal_stiffness, overlap);
    sum.slope -= contact_push(physics.contact->normal_stiffness, overlap);
  }
  return sum;
}

// Returns the bracket of C for a spring that has grown by `stretch`: 0 at Coulomb's limit, where it slides.
double energy_of_stretch(double stiffness, const Vector3& spring, const Vector3& stretch, double limit) {
  return sticks(stiffness, spring, limit) ? -spring_energy(stiffness, stretch) : 0;
}

double energy_of_pair(const Physics& physics, const PairKind& kind, const PairGeometry& shape,
                      const PairMotion& motion, const ContactSprings& springs, double timestep) {
  const double before = norm(shape.separation - timestep * motion.velocity);
  const Potential now = potential(physics, kind, shape.distance);
  double sum = now.energy - potential(physics, kind, before).energy -
               timestep * dot(motion.velocity, shape.normal) * now.slope;
  if (shape.overlap() > 0 && physics.contact) {
    const ContactParameters& contact = *physics.contact;
    const double pressing = frictional_load(contact, shape.overlap());
    const ContactOf<double> touch = contact_of(contact, kind, shape);
    for_each_spring_law([&](auto law) {
      using Law = decltype(law);
      if (Law::may_slide && springs.slides != 0) return;
      sum += energy_of_stretch(Law::stiffness(contact), Law::of(springs),
                               timestep * Law::stretch_rate(touch, motion),
                               Law::coefficient(contact) * pressing);
    });
  }
  return sum;
}

}  // namespace

double spurious_energy(const System& system, const std::vector<PairKind>& kinds, const Physics& physics,
                       const VectorField& force, const VectorField& torque, double timestep) {
  const ParticleState& particles = system.particles;
  double kinetic = 0;
  for (std::size_t i = 0; i < particles.count(); ++i) {
    kinetic += dot(force[i], force[i]) / particles.mass[i] + dot(torque[i], torque[i]) / particles.inertia[i];
  }
  const HalfStepMotion half_step(particles, force, torque, timestep);
  const std::vector<ImageFrame> frames = image_frames(system.list, system.box);
  const std::vector<Pair>& pairs = system.list.pairs();
  double elastic = 0;
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    const ImageFrame& frame = frames[pairs[p].image];
    const PairKind& kind = kinds[pairs[p].kind];
    // Pairs that have just separated count, too.
    elastic += energy_of_pair(physics, kind, geometry(separation(particles, pairs[p], frame), kind),
                              half_step.of(pairs[p], frame), system.springs[p], timestep);
  }
  return 0.5 * timestep * timestep * kinetic + elastic;
}

}  // namespace peclet::engine
