// The stress depends neither on the origin nor on the choice of lattice vectors.
//
// Without noise, because its random numbers are tied to the named images. Round-off differs between
// descriptions and grows slowly along trajectories; 1e-9 allows for it over a few hundred steps.
#include <gtest/gtest.h>

#include "engine/realisation/packing.h"
#include "tests/engine/components.h"
#include "tests/physics/laboratory.h"

namespace peclet::engine {
namespace {

constexpr double rate = 0.1;
constexpr int steps = 400;

std::vector<double> radii() {
  std::vector<double> radius(28, 1.0);
  radius.resize(40, 1.4);
  return radius;
}

const double edge = cube_edge(radii(), 0.5);

// Returns a suspension with every kind of pair force, friction and rolling with memory included.
Laboratory sheared_suspension(double tilt, const LubricationParameters& lubrication) {
  Experiment experiment;
  experiment.physics.viscosity = natural_viscosity;
  experiment.physics.flow = steady_shear(rate);
  experiment.physics.contact = ContactParameters{.normal_stiffness = 500,
                                                 .normal_damping = 0.2,
                                                 .friction = 0.5,
                                                 .tangential_stiffness = 140,
                                                 .rolling_stiffness = 10,
                                                 .rolling_friction = 0.2};
  experiment.physics.lubrication = lubrication;
  experiment.physics.repulsion = RepulsionParameters{1e-2, 0.01, 20};
  experiment.radius = radii();
  experiment.box = PeriodicCell({edge, edge, edge}, simple_shear(rate), tilt);
  experiment.timestep = 4e-3;
  return Laboratory(experiment);
}

// Places the spheres in a fixed state of motion, all shifted by `offset`. Velocities are those of the flow at
// the new heights plus fixed disturbances.
void place(Laboratory& laboratory, const Vector3& offset) {
  ParticleState& all = laboratory.particles();
  place_randomly(all, PeriodicCell({edge, edge, edge}, Matrix3{}, 0.4 * edge), /*seed=*/4);
  std::mt19937_64 generator(31);
  std::uniform_real_distribution<double> disturbance(-0.05, 0.05);
  for (std::size_t i = 0; i < all.count(); ++i) {
    const double u = disturbance(generator), v = disturbance(generator), w = disturbance(generator);
    all.position.set(i, all.position[i] + offset);
    all.velocity.set(i, {rate * all.position[i].y + u, v, w});
    all.angular_velocity.set(i, {v, w, u - 0.5 * rate});
  }
  laboratory.start();
}

void expect_same_stress(Laboratory& one, Laboratory& other) {
  double contacts = 0;
  for (int step = 0; step < steps; ++step) {
    const PairSums a = one.step().sums, b = other.step().sums;
    ASSERT_EQ(a.contacts, b.contacts) << "step " << step;
    contacts += a.contacts;
    for (std::size_t term = 0; term < count_of_stress_terms; ++term) {
      const SymmetricTensor s = a.stress[term], t = b.stress[term];
      const double scale = std::abs(s.xx) + std::abs(s.yy) + std::abs(s.zz);
      for (const auto component : every_component) {
        ASSERT_NEAR(s.*component, t.*component, 1e-9 * scale) << "step " << step << ", term " << term;
      }
    }
  }
  EXPECT_GT(contacts, static_cast<std::uint64_t>(4 * steps)) << "hardly any contacts were compared";
}

constexpr LubricationParameters forms[] = {
    {.inner_gap = 1e-2, .outer_gap = 0.05},
    {.inner_gap = 1e-2, .form = LubricationParameters::Form::mari, .outer_distance = 0.05}};

TEST(Frame, AnotherOriginGivesTheSameStress) {
  for (const LubricationParameters& form : forms) {
    for (const Vector3& offset :
         {Vector3{0, 0.37 * edge, 0}, Vector3{0.21 * edge, -2.6 * edge, 0.77 * edge}}) {
      Laboratory one = sheared_suspension(0.4 * edge, form), other = sheared_suspension(0.4 * edge, form);
      place(one, {});
      place(other, offset);
      expect_same_stress(one, other);
    }
  }
}

// A strain of 0.16 takes the tilt of 0.4 beyond one half, so one of the boxes flips.
TEST(Frame, AnotherBasisOfTheLatticeGivesTheSameStress) {
  for (const LubricationParameters& form : forms) {
    Laboratory one = sheared_suspension(0.4 * edge, form), other = sheared_suspension(-0.6 * edge, form);
    place(one, {});
    place(other, {});
    expect_same_stress(one, other);
    EXPECT_EQ(one.system().box.basis(), flips(1));
  }
}

}  // namespace
}  // namespace peclet::engine
