// Fluctuation–dissipation for near pairs: the noise of the pair pass has the covariance 2 kT R / dt of the
// resistance that the pair pass applies (eqs. 19-28 of Li, Royer & Ness 2023).
//
// False failures with fresh seeds: one deviation passes 5.5 standard deviations with probability 3.8e-8. One
// of 90 (12 components and their means) in one of 18 cases does so with 6e-5, one of 324 with 1.2e-5.
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "engine/kernels/pair_pass.h"
#include "tests/physics/laboratory.h"
#include "tests/physics/reference_resistance.h"
#include "tests/physics/sampled_covariance.h"

namespace peclet::engine {
namespace {

constexpr double largest_sigma = 5.5;
constexpr double inner_gap = 1e-3, outer_gap = 0.05;
constexpr double thermal_energy = 0.3, timestep = 2e-3;
constexpr double radius_i = 0.8;
constexpr std::uint64_t samples = 100000;

using Components = Vector12;  // F_i, F_j, T_i, T_j

// Two spheres at a gap, in a direction without zero components; forces are those of the pair pass alone.
class NoisyPair {
 public:
  NoisyPair(double ratio, double gap, std::uint64_t seed)
      : random_(seed, Purpose::pair_noise),
        radius_j_(ratio * radius_i),
        separation_((1 + 0.5 * gap) * (radius_i + radius_j_) * (1 / norm(direction)) * direction) {
    physics_.viscosity = viscosity;
    physics_.thermal_energy = thermal_energy;
    physics_.lubrication = LubricationParameters{inner_gap, outer_gap};
    system_.particles = make_particles({radius_i, radius_j_}, 1);
    const double edge = 20 * (radius_i + radius_j_);
    system_.box = PeriodicCell({edge, edge, edge}, Matrix3{});
    kinds_ = make_pair_kinds(physics_, {radius_i, radius_j_});
    system_.list = NeighbourList(range_table(kinds_, 2), 0.1);
    // The pair lies across a face of the periodic cell.
    system_.particles.position.set(0, {edge - 0.1, 0.1, 0.1});
    system_.particles.position.set(1, system_.particles.position[0] + separation_);
    rebuild_neighbours(system_);
  }

  Components noise(std::uint64_t step) {
    VectorField force(2), torque(2);
    const PairPassInput input = {.particles = system_.particles,
                                 .list = system_.list,
                                 .box = system_.box,
                                 .kinds = kinds_,
                                 .parameters = pair_parameters(physics_, timestep),
                                 .noise = random_.key(step)};
    pass_.evaluate(input, system_.springs, force, torque);
    Components c;
    c << to_eigen(force[0]), to_eigen(force[1]), to_eigen(torque[0]), to_eigen(torque[1]);
    return c;
  }

  Matrix12 expected_covariance() const {
    return 2 * thermal_energy / timestep *
           reference_resistance(viscosity, radius_i, radius_j_, separation_, inner_gap);
  }

  // Returns the sample with the sign that the published eq. 24 prints before the second root. The
  // contribution of theta to T_j is Y_B21 / Y_A F_i x n, where -Y_B21 v x n is the block (F_j, T_j) of -R;
  // the rest comes from chi.
  Components with_printed_sign(Components c) const {
    const Matrix12 R = reference_resistance(viscosity, radius_i, radius_j_, separation_, inner_gap);
    const Eigen::Vector3d n = to_eigen(separation_).normalized(), across = n.unitOrthogonal();
    const Eigen::Vector3d turned = across.cross(n);
    const double shear = across.dot(R.topLeftCorner<3, 3>() * across);
    const double pump_j = turned.dot(R.bottomLeftCorner<3, 3>() * across);
    const Eigen::Vector3d by_theta = pump_j / shear * c.head<3>().cross(n);
    c.tail<3>() = 2 * by_theta - c.tail<3>();
    return c;
  }

 private:
  static constexpr Vector3 direction = {0.48, -0.64, 0.6};
  static constexpr double viscosity = 0.7;

  KeyedRandom random_;
  double radius_j_;
  Vector3 separation_;
  Physics physics_;
  System system_;
  std::vector<PairKind> kinds_;
  PairPass pass_{{.lubrication = true, .noise = true}, chosen_instruction_set()};
};

// Gaps: overlap, below the inner gap, at it, and up to the outer one.
constexpr std::array<double, 3> ratios = {1.4, 3.0, 7.0};
constexpr std::array<double, 6> gaps = {-0.01, 5e-4, 1e-3, 4e-3, 0.02, 0.0499};

template <class Check>
void for_each_pair(Check&& check) {
  std::uint64_t seed = 20240607;
  for (const double ratio : ratios) {
    for (const double gap : gaps) {
      SCOPED_TRACE(testing::Message() << "ratio " << ratio << ", gap " << gap);
      NoisyPair pair(ratio, gap, seed++);
      check(pair, pair.expected_covariance());
    }
  }
}

TEST(PairNoise, SampledCovarianceEqualsTheResistance) {
  for_each_pair([](NoisyPair& pair, const Matrix12& expected) {
    SampledCovariance sampled(12);
    for (std::uint64_t step = 0; step < samples; ++step) sampled.add(pair.noise(step));
    EXPECT_LT(sampled.largest_deviation(expected), largest_sigma);
    EXPECT_LT(sampled.largest_mean(expected), largest_sigma);
  });
}

// The printed plus makes <T_i T_j> two to four times too large.
TEST(PairNoise, PrintedSignOfTheSecondTorqueFailsByFar) {
  for_each_pair([](NoisyPair& pair, const Matrix12& expected) {
    SampledCovariance sampled(12);
    for (std::uint64_t step = 0; step < samples; ++step) {
      sampled.add(pair.with_printed_sign(pair.noise(step)));
    }
    EXPECT_GT(sampled.largest_deviation(expected), 10 * largest_sigma);
  });
}

// Twenty-four components, of one step and of the next: the two blocks must be independent.
TEST(PairNoise, IsFreshAtEveryStep) {
  NoisyPair pair(1.4, 0.01, 1);
  Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(24, 24);
  expected.topLeftCorner<12, 12>() = expected.bottomRightCorner<12, 12>() = pair.expected_covariance();
  SampledCovariance sampled(24);
  Eigen::VectorXd two(24);
  two.head<12>() = pair.noise(0);
  for (std::uint64_t step = 1; step < samples; ++step) {
    two.tail<12>() = pair.noise(step);
    sampled.add(two);
    two.head<12>() = two.tail<12>();
  }
  EXPECT_LT(sampled.largest_deviation(expected), largest_sigma);
}

TEST(PairNoise, IsZeroBeyondTheOuterGap) {
  NoisyPair pair(3.0, 0.0501, 1);
  for (const double component : pair.noise(7)) EXPECT_EQ(component, 0.0);
}

}  // namespace
}  // namespace peclet::engine
