// Shear along another axis: forces and stresses rotate with the configuration.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "tests/engine/dense_suspension.h"
#include "tests/engine/few_spheres.h"
#include "tests/engine/pair_evaluation.h"

namespace peclet::engine {
namespace {

Matrix3 transposed(const Matrix3& a) {
  const auto& [x, y, z] = a.column;
  return {Vector3{x.x, y.x, z.x}, Vector3{x.y, y.y, z.y}, Vector3{x.z, y.z, z.z}};
}

// Returns a rotation about an axis that is not one of the box.
Matrix3 rotation() {
  const double c = std::cos(0.7), s = std::sin(0.7), d = std::cos(1.9), t = std::sin(1.9);
  const Matrix3 about_z = {Vector3{c, s, 0}, Vector3{-s, c, 0}, Vector3{0, 0, 1}};
  const Matrix3 about_x = {Vector3{1, 0, 0}, Vector3{0, d, t}, Vector3{0, -t, d}};
  return about_x * about_z;
}

Matrix3 turned(const Matrix3& a) { return rotation() * a * transposed(rotation()); }

SymmetricTensor turned(const SymmetricTensor& s) {
  const Matrix3 t =
      turned(Matrix3{Vector3{s.xx, s.xy, s.xz}, Vector3{s.xy, s.yy, s.yz}, Vector3{s.xz, s.yz, s.zz}});
  return {t.column[0].x, t.column[1].y, t.column[2].z, t.column[1].x, t.column[2].x, t.column[2].y};
}

class TurnedShear final : public Deformation {
 public:
  explicit TurnedShear(double rate) : rate_(rate) {}
  Matrix3 velocity_gradient(double /*time*/) const override { return turned(simple_shear(rate_)); }
  Matrix3 displacement_gradient(double time) const override { return turned(simple_shear(rate_ * time)); }
  double largest_rate() const override { return rate_; }
  Matrix3 steady_gradient(double /*from*/) const override { return velocity_gradient(0); }
  double time_of(double strain, double /*from*/) const override { return strain / rate_; }

 private:
  double rate_;
};

Physics turned(Physics physics) {
  physics.flow = ImposedFlow(std::make_shared<TurnedShear>(physics.flow.rate()));
  return physics;
}

// Returns the rotated system with rotated springs, which keep their names.
System turned(const System& system) {
  const Matrix3 q = rotation();
  System other;
  other.particles = system.particles;
  for (std::size_t i = 0; i < system.particles.count(); ++i) {
    other.particles.position.set(i, q * system.particles.position[i]);
    other.particles.velocity.set(i, q * system.particles.velocity[i]);
    other.particles.angular_velocity.set(i, q * system.particles.angular_velocity[i]);
  }
  other.box = PeriodicCell::with_edges(q * system.box.edges(), turned(system.box.velocity_gradient()));
  other.list = NeighbourList(system.list.ranges(), 0.05);
  other.springs = SpringField(system.springs.kinds(), 0);
  rebuild_neighbours(other);
  std::vector<HeldContact> held = held_contacts(system.list, system.particles, system.springs);
  for (HeldContact& contact : held) {
    contact.springs.tangential = q * contact.springs.tangential;
    contact.springs.rolling = q * contact.springs.rolling;
  }
  other.springs = placed_contacts(other.list, other.particles, held, other.springs.kinds());
  return other;
}

std::vector<Vector3> by_id(const ParticleState& particles, const VectorField& field) {
  std::vector<Vector3> all(particles.count());
  for (std::size_t i = 0; i < particles.count(); ++i) all[particles.id[i]] = field[i];
  return all;
}

void expect_turned(const PairSums& plain, const PairSums& other, double bound, const std::string& what) {
  for (std::size_t t = 0; t < count_of_stress_terms; ++t) {
    const SymmetricTensor expected = turned(plain.stress[t]), &found = other.stress[t];
    const auto size = [](const SymmetricTensor& s) {
      return std::sqrt(s.xx * s.xx + s.yy * s.yy + s.zz * s.zz +
                       2 * (s.xy * s.xy + s.xz * s.xz + s.yz * s.yz));
    };
    EXPECT_LE(size(found + -1.0 * expected), bound * size(expected)) << what << " term " << t;
  }
}

TEST(TurnedFrame, TurnsForcesAndStressesOfEveryRecipe) {
  for (const Terms& terms : every_recipe()) {
    if (terms.noise) continue;  // random numbers are tied to the axes
    const Physics physics = physics_with(terms);
    const System system = dense_suspension(physics, 200, 12), other = turned(system);
    const Evaluation plain = evaluated(physics, system), found = evaluated(turned(physics), other);
    expect_turned(plain.sums, found.sums, 1e-10, text(terms));
    const std::vector<Vector3> expected = by_id(system.particles, plain.force),
                               force = by_id(other.particles, found.force);
    double largest = 0, farthest = 0;
    for (std::size_t i = 0; i < force.size(); ++i) {
      largest = std::max(largest, norm(expected[i]));
      farthest = std::max(farthest, norm(force[i] - rotation() * expected[i]));
    }
    EXPECT_LE(farthest, 1e-10 * largest) << text(terms);
  }
}

// Explicit and implicit steps lead to rotated stresses, implicit ones within the solver's tolerance.
TEST(TurnedFrame, TurnsTheWaysOfBothMethods) {
  const Physics physics =
      physics_with({.lubrication = true, .contact = true, .friction = true, .conservative = true});
  const System system = dense_suspension(physics, 200, 12);
  const auto stepped = [&](const Physics& of, System copy, bool implicit) {
    const auto integrator = steps_of_method(implicit, of, copy, (implicit ? 10 : 0.1) * timestep, 1e-7);
    integrator->start(copy);
    StepReport report;
    for (int n = 0; n < 20; ++n) report = integrator->advance(copy);
    return report.sums;
  };
  for (const bool implicit : {false, true}) {
    expect_turned(stepped(physics, system, implicit), stepped(turned(physics), turned(system), implicit),
                  implicit ? 1e-4 : 1e-10, implicit ? "implicit" : "explicit");
  }
}

}  // namespace
}  // namespace peclet::engine
