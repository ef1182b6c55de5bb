// Implicit steps on several threads, also on more threads than processors or blocks of particles.
#include <gtest/gtest.h>

#include <array>

#include "engine/flow/waves.h"
#include "engine/integrators/implicit.h"
#include "tests/engine/available_sets.h"
#include "tests/engine/bits.h"
#include "tests/engine/dense_suspension.h"

namespace peclet::engine {
namespace {

// The last of several steps that rebuild the list.
struct Outcome {
  System system;
  StepReport report;
};

Outcome after_steps(const Physics& physics, System system, InstructionSet set, int threads) {
  constexpr double step = 0.01, tolerance = 1e-3;
  constexpr std::uint64_t seed = 5;
  Outcome outcome{std::move(system), {}};
  const std::unique_ptr<Implicit> steps =
      implicit_steps(physics, outcome.system.particles, step, tolerance, seed, threads, set);
  steps->start(outcome.system);
  for (int k = 0; k < 4; ++k) outcome.report = steps->advance(outcome.system);
  return outcome;
}

std::vector<std::uint64_t> bits_of_all(const System& system) {
  std::vector<std::uint64_t> bits;
  const ParticleState& particles = system.particles;
  for (const VectorField* field : {&particles.position, &particles.velocity, &particles.angular_velocity}) {
    for (std::size_t i = 0; i < particles.count(); ++i) {
      for (int c = 0; c < 3; ++c) bits.push_back(std::bit_cast<std::uint64_t>(field->row(i)[c]));
    }
  }
  for (std::size_t c = 0; c < system.springs.components(); ++c) {
    for (const double value : system.springs.values(c)) bits.push_back(std::bit_cast<std::uint64_t>(value));
  }
  return bits;
}

struct Kind {
  const char* name;
  Terms terms;
  double thermal_energy;
  bool strained = false;  // lubrication by strain rates, in waves
};
constexpr Kind kinds[] = {
    {"quiet", {.lubrication = true, .contact = true, .friction = true, .rolling = true}, 0},
    {"noisy", {.lubrication = true, .noise = true, .contact = true, .friction = true}, 0.02},
    {"strained", {.lubrication = true, .contact = true}, 0, true},
};

class ThreadsOf : public testing::TestWithParam<InstructionSet> {};
INSTANTIATE_TEST_SUITE_P(EverySet, ThreadsOf, testing::ValuesIn(available_sets()),
                         [](const auto& set) { return std::string(name_of(set.param)); });

TEST_P(ThreadsOf, ImplicitStepsHaveTheSameBitsWhateverTheirNumber) {
  for (const Kind& kind : kinds) {
    Physics physics = physics_with(kind.terms);
    physics.thermal_energy = kind.thermal_energy;
    if (kind.strained) {
      physics.lubrication =
          LubricationParameters{.form = LubricationParameters::Form::mari, .outer_distance = 0.05};
      physics.flow = ImposedFlow(std::make_shared<SteadyShear>(physics.flow.rate()),
                                 std::make_shared<Waves>(std::vector<Wave>{{1, 0.4, 0.1}}, false));
    }
    const System start = dense_suspension(physics, 8200, 7);
    const Outcome one = after_steps(physics, start, GetParam(), 1);
    ASSERT_EQ(one.system.list.blocks().size(), 4u);
    EXPECT_GT(one.system.list.crossings(), 1000u) << kind.name;
    EXPECT_GT(one.system.list.builds(), start.list.builds() + 1) << kind.name;
    EXPECT_GT(one.report.solver_iterations, 3) << kind.name;
    EXPECT_TRUE(one.report.sums.finite) << kind.name;
    const std::vector<std::uint64_t> bits = bits_of_all(one.system);
    for (const int threads : {2, 3, 5}) {
      const Outcome many = after_steps(physics, start, GetParam(), threads);
      EXPECT_TRUE(bits_of_all(many.system) == bits) << kind.name << ", " << threads << " threads";
      EXPECT_EQ(bits_of(std::to_array(many.report.sums.stress)),
                bits_of(std::to_array(one.report.sums.stress)))
          << kind.name << ", " << threads << " threads";
      EXPECT_EQ(bits_of(std::array{many.report.motion}), bits_of(std::array{one.report.motion}))
          << kind.name << ", " << threads << " threads";
      EXPECT_EQ(many.report.solver_residual, one.report.solver_residual);
      EXPECT_EQ(many.report.largest_displacement, one.report.largest_displacement);
    }
  }
}

}  // namespace
}  // namespace peclet::engine
