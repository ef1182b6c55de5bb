// Steps of the program for cards are those of the processor, to the tolerance of their solutions.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <deque>

#include "engine/realisation/card_ensemble.h"
#include "tests/engine/realisation/card_scenes.h"
#include "tests/engine/realisation/small_result.h"

namespace peclet::engine {
namespace {

std::vector<double> numbers_of(const SymmetricTensor& t) { return {t.xx, t.yy, t.zz, t.xy, t.xz, t.yz}; }

// Makes steps on the emulated card.
void advance_on_card(Simulation& simulation, std::uint64_t steps) {
  CardEnsemble ensemble(emulated_card(1));
  ensemble.add(simulation);
  const std::uint64_t from = simulation.system().step;
  while (ensemble.steps_made(simulation) < from + steps) {
    ensemble.limit_steps(from + steps - ensemble.steps_made(simulation));
    ASSERT_TRUE(ensemble.advance(std::chrono::duration<double>(1)).empty());
  }
  ensemble.remove(simulation);
}

// Differences over what is compared, but that of positions.
struct Differences {
  double velocity = 0, spin = 0, position = 0, springs = 0, stress = 0, samples = 0;
};

// The root of a mean square of differences over that of the values.
class Ratio {
 public:
  void add(const Vector3& a, const Vector3& b) {
    difference_ += dot(a - b, a - b);
    whole_ += dot(a, a);
  }
  double value() const { return difference_ == 0 ? 0 : std::sqrt(difference_ / whole_); }

 private:
  double difference_ = 0, whole_ = 0;
};

BlockSums window_of(const Simulation& simulation) { return sum_of(simulation.production().blocks()); }

// Returns the largest difference of two components.
double apart(const SymmetricTensor& a, const SymmetricTensor& b) {
  const std::vector<double> x = numbers_of(a), y = numbers_of(b);
  double largest = 0;
  for (std::size_t c = 0; c < x.size(); ++c) largest = std::max(largest, std::abs(x[c] - y[c]));
  return largest;
}

Differences differences(const Simulation& before, const Simulation& on_processor, const Simulation& on_card) {
  const System &a = on_processor.system(), &b = on_card.system();
  Differences found;
  EXPECT_EQ(a.step, b.step);
  EXPECT_EQ(a.clock.time(), b.clock.time());
  EXPECT_EQ(a.box.strain(), b.box.strain());
  EXPECT_EQ(a.box.basis(), b.box.basis());
  EXPECT_EQ(a.list.builds(), b.list.builds());
  EXPECT_EQ(a.list.moment_of_candidates().displacement_gradient,
            b.list.moment_of_candidates().displacement_gradient);
  EXPECT_EQ(a.list.listed().displacement_gradient, b.list.listed().displacement_gradient);
  EXPECT_TRUE(a.particles.image == b.particles.image);
  Ratio velocity, spin, springs;
  const Matrix3& gradient = a.box.velocity_gradient();
  const Vector3 flow_spin{0, 0, -0.5 * gradient.column[1].x};
  for (std::size_t i = 0; i < a.particles.count(); ++i) {
    const auto relative = [&](const System& system) {
      return system.particles.velocity[i] - gradient * system.particles.position[i];
    };
    velocity.add(relative(a), relative(b));
    spin.add(a.particles.angular_velocity[i] - flow_spin, b.particles.angular_velocity[i] - flow_spin);
    found.position = std::max(found.position, norm(a.particles.position[i] - b.particles.position[i]));
  }
  EXPECT_EQ(a.list.pairs().size(), b.list.pairs().size());
  std::size_t sprung = 0;
  for (std::size_t p = 0; p < std::min(a.list.pairs().size(), b.list.pairs().size()); ++p) {
    const ContactSprings x = a.springs[p], y = b.springs[p];
    springs.add(x.tangential, y.tangential);
    springs.add(x.rolling, y.rolling);
    EXPECT_EQ(x.slides, y.slides) << p;
    sprung += norm(x.tangential) > 0 ? 1 : 0;
  }
  if (a.springs.kinds() != SpringKinds::none) {
    EXPECT_GT(sprung, 3U);
  }
  found.velocity = velocity.value();
  found.spin = spin.value();
  found.springs = springs.value();
  // The sums of these steps.
  const BlockSums x = window_of(on_processor), y = window_of(on_card), from = window_of(before);
  EXPECT_EQ(x.steps, y.steps);
  EXPECT_EQ(x.samples, y.samples);
  EXPECT_EQ(x.contacts, y.contacts);
  EXPECT_NEAR(x.shear_rate, y.shear_rate, 1e-12 * x.shear_rate);
  double whole = 0;
  const auto note = [&](const SymmetricTensor& p, const SymmetricTensor& q, const SymmetricTensor& earlier) {
    const double size = std::max(apart(p, earlier), 1e-3 * whole);
    if (apart(p, q) > 0) found.stress = std::max(found.stress, apart(p, q) / size);
  };
  for (std::size_t t = 0; t < count_of_stress_terms; ++t) {
    whole = std::max(whole, apart(x.stress[t], from.stress[t]));
  }
  for (std::size_t t = 0; t < count_of_stress_terms; ++t) note(x.stress[t], y.stress[t], from.stress[t]);
  note(x.motion, y.motion, from.motion);
  note(x.structural_brownian, y.structural_brownian, from.structural_brownian);
  const auto ratio = [](double p, double q) { return p == q ? 0 : std::abs(p - q) / std::abs(p); };
  found.samples = std::max({ratio(x.overlaps, y.overlaps),
                            ratio(on_processor.largest_overlap(), on_card.largest_overlap()),
                            ratio(x.temperature.translational, y.temperature.translational),
                            ratio(x.temperature.rotational, y.temperature.rotational)});
  return found;
}

// Returns a sheared state from which the processor finds all velocities of the next steps, and in these steps
// the second lattice vector jumps. Where forces jump there may be no solution, and what is left depends on
// the way.
std::string state_before_a_jump(const Scene& scene, std::size_t steps) {
  struct Moment {
    std::string bytes;
    std::int32_t basis;
    double residuals;
  };
  constexpr double far = 10;
  constexpr std::uint64_t patience = 20000;
  Simulation at = started(scene, usual_seed);
  std::deque<Moment> last;
  for (; at.system().step < patience; at.advance(1)) {
    const Moment now = {bytes_of(at), at.system().box.basis().column[1].x,
                        at.step_errors().sum_of_solver_residuals};
    if (!last.empty() && now.residuals - last.back().residuals > far * scene.solver_tolerance) last.clear();
    last.push_back(now);
    if (last.size() > steps + 1) last.pop_front();
    const bool has_jumped =
        last.front().basis != last.back().basis && last[steps / 2].basis == last.front().basis;
    if (last.size() == steps + 1 && has_jumped && now.residuals > 0) return last.front().bytes;
  }
  throw std::runtime_error("no such state");
}

// Makes `steps` steps from a state, and expects the processor's. Returns the realisation on the card.
Simulation expect_steps_of_the_processor(const Scene& scene, const std::string& start, std::uint64_t steps,
                                         double bound) {
  SCOPED_TRACE(steps);
  Simulation before = simulation_of(scene, usual_seed), on_processor = simulation_of(scene, usual_seed),
             on_card = simulation_of(scene, usual_seed);
  for (Simulation* const one : {&before, &on_processor, &on_card}) load(*one, start);
  EXPECT_FALSE(on_processor.advance(steps));
  advance_on_card(on_card, steps);
  const Differences found = differences(before, on_processor, on_card);
  EXPECT_LT(found.velocity, bound);
  EXPECT_LT(found.spin, bound);
  EXPECT_LT(found.position, 0.1 * bound);  // radii
  EXPECT_LT(found.springs, bound);
  EXPECT_LT(found.stress, 3 * bound);  // of the smallest terms
  EXPECT_LT(found.samples, bound);
  EXPECT_EQ(on_card.step_errors().divided_steps, on_processor.step_errors().divided_steps);
  EXPECT_EQ(on_card.step_errors().deepest_division, on_processor.step_errors().deepest_division);
  // Residuals are compared where springs that slide leave more than the tolerance.
  const auto gained = [&](const Simulation& one, auto member) {
    return static_cast<double>(one.step_errors().*member - before.step_errors().*member);
  };
  const auto residuals = [&](const Simulation& one) {
    return gained(one, &StepErrors::sum_of_solver_residuals) / static_cast<double>(steps);
  };
  if (residuals(on_processor) > 2 * scene.solver_tolerance) {
    EXPECT_NEAR(residuals(on_card), residuals(on_processor), 0.1 * residuals(on_processor));
  }
  const double iterations = gained(on_card, &StepErrors::solver_iterations);
  EXPECT_LE(iterations, 6 * gained(on_processor, &StepErrors::solver_iterations));
  EXPECT_GT(iterations, 0);
  return on_card;
}

class CardSteps : public testing::TestWithParam<NamedScene> {};

// Velocities are found to the tolerance, in the energy norm. Errors of eight steps add up.
TEST_P(CardSteps, AreThoseOfTheProcessor) {
  constexpr std::uint64_t many = 8;
  const Scene scene = read_scene(GetParam().scene, "scene.json");
  const std::string start = state_before_a_jump(scene, many);
  expect_steps_of_the_processor(scene, start, 1, scene.solver_tolerance);
  const Simulation after = expect_steps_of_the_processor(scene, start, many, 3 * scene.solver_tolerance);
  Simulation before = simulation_of(scene, usual_seed);
  load(before, start);
  EXPECT_NE(before.system().box.basis(), after.system().box.basis());
  EXPECT_GT(after.system().list.builds(), before.system().list.builds());
}

TEST(CardStepsAtRest, AreThoseOfTheProcessor) {
  for (const Json& patch :
       {together({with_noise, at_rest}), together({with_strong_noise, without_friction, at_rest})}) {
    const Scene scene = read_scene(card_scene(patch), "scene.json");
    Simulation at = started(scene, usual_seed);
    at.advance(at.schedule().equilibration);
    expect_steps_of_the_processor(scene, bytes_of(at), 8, 3 * scene.solver_tolerance);
  }
}

// The guard lets spheres move a small part of their usual way.
const Json with_short_ways = Json::parse(R"({"guard": {"largest_displacement": 0.003}})");

TEST(CardStepsInParts, AreThoseOfTheProcessor) {
  for (const Json& patch :
       {Json::object(), without_friction, with_noise, together({with_noise, without_friction}),
        together({with_noise, strained_lubrication})}) {
    SCOPED_TRACE(patch.dump());
    const Scene scene = read_scene(card_scene(together({patch, with_short_ways})), "scene.json");
    Simulation at = started(scene, usual_seed);
    at.advance(at.schedule().equilibration);
    const std::string start = bytes_of(at);
    expect_steps_of_the_processor(scene, start, 1, scene.solver_tolerance);
    const Simulation after = expect_steps_of_the_processor(scene, start, 8, 3 * scene.solver_tolerance);
    EXPECT_GT(after.step_errors().divided_steps, 0U);
    EXPECT_GT(after.step_errors().deepest_division, 1U);
  }
}

TEST(CardStepsOfAWindow, AreComparedAndPutIntoBlocksAsOnTheProcessor) {
  const Scene scene = read_scene(card_scene(together({without_friction, Json::parse(R"({
      "integrator": {"timestep": 0.005},
      "duration": {"equilibration": {"time": 0.05}, "production": {"time": 0.65}}})")})),
                                 "scene.json");
  Simulation on_processor = started(scene, usual_seed), on_card = started(scene, usual_seed);
  ASSERT_TRUE(on_processor.advance(on_processor.schedule().total()));
  CardEnsemble ensemble(emulated_card(1));
  ensemble.add(on_card);
  while (ensemble.advance(std::chrono::duration<double>(1)).empty()) {
  }
  for (std::size_t b = 0; b < count_of_blocks; ++b) {
    const BlockSums &x = on_processor.production().blocks()[b], &y = on_card.production().blocks()[b];
    EXPECT_EQ(x.steps, y.steps) << b;
    EXPECT_EQ(x.samples, y.samples) << b;
    EXPECT_EQ(x.planned, y.planned) << b;
    if (b == 0) {
      EXPECT_LT(apart(x.stress[0], y.stress[0]), 1e-2 * apart(x.stress[0], {}));
    }
  }
  // Rounding errors have grown by then.
  const Integrator::HalfSteps a = on_processor.step_errors().half_steps, b = on_card.step_errors().half_steps;
  EXPECT_NE(a.whole, 0);
  EXPECT_NEAR(a.whole, b.whole, 0.01 * std::abs(a.whole));
  EXPECT_NEAR(a.halved, b.halved, 0.01 * std::abs(a.halved));
}

// Returns how a realisation ends on the card.
Ending ending_on_card(Simulation& simulation) {
  CardEnsemble ensemble(emulated_card(1));
  ensemble.add(simulation);
  while (true) {
    const std::vector<Ensemble::Ended> ended = ensemble.advance(std::chrono::duration<double>(1));
    if (!ended.empty()) return ended.front().ending;
  }
}

void expect_ending_of_the_processor(const Scene& scene, const System& start, Ending::Cause cause) {
  Simulation on_processor = simulation_of(scene, usual_seed), on_card = simulation_of(scene, usual_seed);
  on_processor.start(start);
  on_card.start(start);
  const Ending a = on_processor.advance(on_processor.schedule().total()).value();
  const Ending b = ending_on_card(on_card);
  EXPECT_EQ(a.cause, cause) << a.message;
  EXPECT_EQ(b.cause, cause) << b.message;
  EXPECT_EQ(a.step, b.step);
  EXPECT_EQ(a.message, b.message);
  EXPECT_EQ(on_card.system().step, b.step);
}

TEST(CardGuards, EndARealisationAsOnTheProcessor) {
  using Cause = Ending::Cause;
  struct Case {
    const char* patch;
    Cause cause;
  };
  for (const Json& noise : {Json::object(), with_noise}) {
    for (const auto& [patch, cause] :
         {Case{R"({"guard": {"largest_overlap": 0.004}, "contact": {"normal_stiffness": 2e3}})",
               Cause::overlap},
          Case{R"({"guard": {"largest_displacement": 1e-6}})", Cause::displacement},
          Case{R"({"duration": {"equilibration": {"time": 0.02}, "production": {"time": 0.5}}})",
               Cause::completed}}) {
      SCOPED_TRACE(patch);
      const Scene scene = read_scene(card_scene(together({noise, Json::parse(patch)})), "scene.json");
      expect_ending_of_the_processor(scene, started(scene, usual_seed).system(), cause);
    }
    const Scene scene = read_scene(card_scene(noise), "scene.json");
    System start = started(scene, usual_seed).system();
    start.particles.velocity.set(3, {std::nan(""), 0, 0});
    expect_ending_of_the_processor(scene, start, Cause::non_finite);
  }
}

INSTANTIATE_TEST_SUITE_P(OfEachScene, CardSteps, testing::ValuesIn(card_scenes()),
                         [](const auto& one) { return one.param.name; });

}  // namespace
}  // namespace peclet::engine
