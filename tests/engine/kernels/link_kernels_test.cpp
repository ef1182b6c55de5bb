// The system of an implicit step is the derivative of the forces that the step is to bring into balance.
#include <gtest/gtest.h>

#include <numbers>

#include "engine/kernels/force_field.h"
#include "tests/engine/dense_suspension.h"
#include "tests/engine/draws.h"
#include "tests/engine/linear_algebra.h"
#include "tests/engine/pair_evaluation.h"

namespace peclet::engine {
namespace {

// Single precision, sums of some ten numbers.
constexpr double single_precision = 2e-6;

constexpr double step = 0.02;
constexpr LinkWeights weights = {.timestep = step, .normal_time = 0.5 * step, .resistance_time = 0};

// Kernels need not start from every particle: rows of all of them, and what belongs to them.
class Links {
 public:
  Links(const Physics& physics, System system, InstructionSet set, const LinkWeights& of_links = weights)
      : kernels_(link_kernels(set)),
        system_(std::move(system)),
        field_(physics, system_.particles, step, seed, 1, set, of_links.normal_time) {
    const ParticleState& particles = system_.particles;
    diagonal_.resize(distinct_radii(particles.radius).size());
    for (std::size_t i = 0; i < particles.count(); ++i) {
      for (int c = 0; c < 3; ++c) {
        Floats& row = diagonal_[particles.size_class[i]].v;
        row[c] = static_cast<float>(particles.mass[i]);
        row[4 + c] = static_cast<float>(particles.inertia[i]);
      }
    }
    count_ = field_.assemble_links(system_, of_links, groups_);
    inverse_blocks_.resize(6 * particles.count());
    std::vector<MotionRow> scratch(rows_of_scratch(particles.count()));
    kernels_.invert_blocks(view(), scratch.data(), inverse_blocks_.data());
  }

  LinkSystem view() const {
    return {.particles = system_.particles.count(),
            .size_class = system_.particles.size_class.data(),
            .diagonal = diagonal_.data(),
            .groups = groups_.data(),
            .count_of_groups = count_,
            .inverse_blocks = inverse_blocks_.data()};
  }
  const LinkKernels& kernels() const { return kernels_; }
  const System& system() const { return system_; }

  std::vector<MotionRow> times(const std::vector<MotionRow>& vector) const {
    std::vector<MotionRow> product(vector.size());
    kernels_.multiply(view(), vector.data(), product.data());
    return product;
  }

  // Loads at the present velocities plus `change`, drag excepted.
  std::vector<double> loads(const std::vector<MotionRow>& change, double scale) {
    System moved = system_;
    for (std::size_t i = 0; i < change.size(); ++i) {
      for (int c = 0; c < 3; ++c) {
        moved.particles.velocity.row(i)[c] += scale * static_cast<double>(change[i].v[c]);
        moved.particles.angular_velocity.row(i)[c] += scale * static_cast<double>(change[i].v[4 + c]);
      }
    }
    VectorField force(change.size()), torque(change.size());
    field_.evaluate(moved, force, torque);
    const Physics& physics = field_.physics();
    std::vector<double> result;
    for (std::size_t i = 0; i < change.size(); ++i) {
      const double a = moved.particles.radius[i], pi = std::numbers::pi;
      const Vector3 streaming = {physics.flow.rate() * moved.particles.position[i].y, 0, 0};
      const Vector3 f = force[i] - 6 * pi * physics.viscosity * a * (streaming - moved.particles.velocity[i]);
      const Vector3 t =
          torque[i] - 8 * pi * physics.viscosity * a * a * a *
                          (Vector3{0, 0, -0.5 * physics.flow.rate()} - moved.particles.angular_velocity[i]);
      result.insert(result.end(), {f.x, f.y, f.z, t.x, t.y, t.z});
    }
    return result;
  }

 private:
  const LinkKernels& kernels_;
  System system_;
  ForceField field_;
  std::vector<MotionRow> diagonal_, inverse_blocks_;
  std::vector<LinkGroup> groups_;
  std::size_t count_ = 0;
};

std::vector<MotionRow> random_rows(std::size_t count, std::uint64_t from) {
  Draws draws(from);
  std::vector<MotionRow> rows(count);
  for (MotionRow& row : rows) {
    const Vector3 u = draws.vector(), w = draws.vector();
    row.v = Floats{static_cast<float>(u.x), static_cast<float>(u.y), static_cast<float>(u.z), 0,
                   static_cast<float>(w.x), static_cast<float>(w.y), static_cast<float>(w.z), 0};
  }
  return rows;
}

// Where a row has numbers: the fourth and the eighth are always zero.
constexpr std::array<int, 6> of_a_motion = {0, 1, 2, 4, 5, 6};

Eigen::Vector<double, 8> entries(const MotionRow& row) {
  return Eigen::Map<const Eigen::Vector<float, 8>>(reinterpret_cast<const float*>(&row.v)).cast<double>();
}

std::vector<double> numbers(const std::vector<MotionRow>& rows) {
  std::vector<double> result;
  for (const MotionRow& row : rows) {
    for (const int c : of_a_motion) {
      result.push_back(static_cast<double>(row.v[c]));
    }
  }
  return result;
}

// Springs that never slide: their secant stiffness is then the tangent one.
Physics sticking(Physics physics) {
  if (physics.contact && physics.contact->friction > 0) {
    physics.contact->friction = 1e6;
    physics.contact->rolling_friction = 1e6;
  }
  return physics;
}

constexpr Terms tried[] = {
    {.lubrication = true},
    {.contact = true},
    {.lubrication = true, .contact = true, .damping = true},
    {.contact = true, .friction = true},
    {.lubrication = true, .contact = true, .friction = true, .rolling = true},
    {.lubrication = true, .contact = true, .conservative = true},
};

std::vector<InstructionSet> available_sets() {
  std::vector<InstructionSet> sets;
  for (const InstructionSet set : {InstructionSet::baseline, InstructionSet::avx2, InstructionSet::avx512}) {
    if (is_available(set)) sets.push_back(set);
  }
  return sets;
}

class LinkKernelsOf : public testing::TestWithParam<InstructionSet> {};
INSTANTIATE_TEST_SUITE_P(EverySet, LinkKernelsOf, testing::ValuesIn(available_sets()),
                         [](const auto& set) { return std::string(name_of(set.param)); });

TEST_P(LinkKernelsOf, MultiplyByTheDerivativeOfTheLoads) {
  for (const Terms& terms : tried) {
    const Physics physics = sticking(physics_with(terms));
    // Ahead of the present distance the levers of friction change as well, which the system leaves out.
    LinkWeights of_links = weights;
    of_links.normal_time = terms.friction ? 0 : weights.normal_time;
    Links links(physics, dense_suspension(physics, 203, 7), GetParam(), of_links);
    const std::size_t count = links.system().particles.count();
    const auto change = random_rows(count, 11);
    // Small enough that no contact opens or closes ahead and the repulsion stays linear.
    constexpr double small = 1e-6;
    const std::vector<double> before = links.loads(change, -small), after = links.loads(change, small);
    std::vector<double> expected = numbers(change);
    for (std::size_t k = 0; k < expected.size(); ++k) {
      const ParticleState& particles = links.system().particles;
      expected[k] *= k % 6 < 3 ? particles.mass[k / 6] : particles.inertia[k / 6];
      expected[k] += step * (before[k] - after[k]) / (2 * small);
    }
    expect_near(expected, numbers(links.times(change)), text(terms), 10 * single_precision);
  }
}

// A pair along x: the load that the approach changes, X_A(r + t v) v, has the derivative X_A + t v dX_A/dr.
TEST_P(LinkKernelsOf, TakeTheChangeOfTheSqueezingResistanceIntoAccount) {
  Physics physics = physics_with({.lubrication = true});
  physics.flow = steady_shear(0);
  const double inner = physics.lubrication->inner_gap;
  const auto squeezing = [&](double h) {  // of equal spheres of radius 1
    const double gap = std::max(h, inner);
    return 6 * std::numbers::pi * physics.viscosity * (0.25 / gap + 9.0 / 40 * std::log(1 / gap));
  };
  struct Case {
    double gap, closing;
    bool clipped;
  };
  for (const Case& one : {Case{0.01, -0.1, false}, Case{0.01, 0.1, false}, Case{0.5 * inner, -0.1, false},
                          Case{0.01, 3, true}}) {
    const double gap = one.gap, velocity = one.closing;
    System system;
    system.particles = make_particles({1, 1}, 0.1);
    system.box = PeriodicCell({20, 20, 20}, Matrix3{});
    system.list = NeighbourList(range_table(make_pair_kinds(physics, {1.0}), 1), 0.1);
    system.particles.position.set(0, {5, 5, 5});
    system.particles.position.set(1, {7 + gap, 5, 5});
    system.particles.velocity.set(1, {velocity, 0, 0});
    rebuild_neighbours(system);
    const double ahead = 0.5 * step;
    Links links(physics, system, GetParam(), {step, 0.5 * step, ahead});
    std::vector<MotionRow> along(2);
    const std::uint32_t second = links.system().particles.id[0] == 1 ? 0 : 1;
    along[second].v[0] = 1;
    const double found = static_cast<double>(links.times(along)[second].v[0]) - system.particles.mass[0];
    constexpr double d = 1e-6;
    const auto load = [&](double v) {
      return squeezing(gap + ahead * (v - velocity)) * v;  // the places are those half a step ahead already
    };
    double expected = (load(velocity + d) - load(velocity - d)) / (2 * d);
    if (one.clipped) {
      ASSERT_LT(expected, 0.5 * squeezing(gap));
      expected = 0.5 * squeezing(gap);
    }
    EXPECT_NEAR(found / (step * expected), 1, 1e-5) << gap << ' ' << velocity;
  }
}

TEST_P(LinkKernelsOf, InvertTheParticlesOwnBlocks) {
  const Physics physics = physics_with({.lubrication = true, .contact = true, .friction = true});
  const Links links(physics, dense_suspension(physics, 61, 7), GetParam());
  const std::size_t count = links.system().particles.count();
  for (std::size_t i = 0; i < count; i += 7) {
    Eigen::Matrix<double, 8, 6> block, inverse;
    for (std::size_t k = 0; k < 6; ++k) {
      std::vector<MotionRow> unit(count);
      unit[i].v[of_a_motion[k]] = 1;
      block.col(static_cast<Eigen::Index>(k)) = entries(links.times(unit)[i]);
      inverse.col(static_cast<Eigen::Index>(k)) = entries(links.view().inverse_blocks[6 * i + k]);
    }
    Eigen::Matrix<double, 8, 6> identity = Eigen::Matrix<double, 8, 6>::Zero();
    identity(of_a_motion, Eigen::all).setIdentity();
    // The ratio of a block's extreme eigenvalues is some hundreds.
    EXPECT_LE(largest_entry(inverse * block(of_a_motion, Eigen::all) - identity), 1e-3) << i;
  }
}

TEST_P(LinkKernelsOf, SolveTheSystem) {
  const Physics physics = physics_with({.lubrication = true, .contact = true, .friction = true});
  const Links links(physics, dense_suspension(physics, 203, 7), GetParam());
  const std::size_t count = links.system().particles.count();
  const auto right = random_rows(count, 12);
  std::vector<MotionRow> solution(count), residual = right, direction(count), product(count);
  const double begin = links.kernels().squared_norm(links.view(), right.data());
  const SolverReport report = links.kernels().solve(
      links.view(), {solution.data(), residual.data(), direction.data(), product.data()}, 1e-10 * begin,
      1000);
  EXPECT_LE(report.squared_residual, 1e-10 * begin);
  EXPECT_GT(report.iterations, 10);
  EXPECT_LT(report.iterations, 200);
  // What it says of the residual is true: in the same norm, to the precision of the numbers.
  std::vector<MotionRow> rest = links.times(solution);
  for (std::size_t i = 0; i < count; ++i) {
    rest[i].v = right[i].v - rest[i].v;
  }
  EXPECT_LT(links.kernels().squared_norm(links.view(), rest.data()), 4e-10 * begin);
}

// Motions that leave all distances as they are cost nothing but what inertia and drag say.
TEST_P(LinkKernelsOf, RigidTranslationFeelsNoLink) {
  const Physics physics = physics_with({.lubrication = true, .contact = true, .friction = true});
  const Links links(physics, dense_suspension(physics, 100, 7), GetParam());
  const std::size_t count = links.system().particles.count();
  std::vector<MotionRow> same(count);
  for (MotionRow& row : same) {
    row.v = Floats{1, -2, 0.5F, 0, 0, 0, 0, 0};
  }
  const auto product = links.times(same);
  for (std::size_t i = 0; i < count; ++i) {
    for (int c = 0; c < 3; ++c) {
      const double mass = links.system().particles.mass[i];
      EXPECT_NEAR(static_cast<double>(product[i].v[c]), mass * static_cast<double>(same[i].v[c]), 1e-4);
      EXPECT_NEAR(static_cast<double>(product[i].v[4 + c]), 0, 1e-4);
    }
  }
}

}  // namespace
}  // namespace peclet::engine
