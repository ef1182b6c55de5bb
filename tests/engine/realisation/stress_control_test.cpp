// Flow at a given stress: the stress, the resulting rate, and the effect of noise.
#include <gtest/gtest.h>

#include <cmath>

#include "engine/realisation/driver.h"
#include "engine/realisation/result.h"
#include "tests/engine/realisation/small_result.h"

namespace peclet::engine {
namespace {

Json at_stress(double stress, const Json& patch) {
  Json document = small_scene({{"flow", {{"shear_rate", nullptr}, {"stress", stress}}},
                               {"integrator", {{"method", "implicit"}, {"timestep", "auto"}}},
                               {"particles", {{"density", 1e-3}}}});
  document.merge_patch(patch);
  return document;
}

std::unique_ptr<Simulation> started(const Json& document) {
  return std::make_unique<Simulation>(engine::started(read_scene(document, "scene.json"), 3));
}

Json result_of(const Json& document, const Simulation& simulation, const Ending& ending) {
  return make_result({"point", 3}, read_scene(document, "scene.json"), simulation, ending, "", {});
}

double inertia_of(const Simulation& simulation) {
  return dynamic_cast<const StressControl&>(simulation.driver()).inertia();
}

// Returns the stress of all terms relative to the imposed one.
double held(const Simulation& simulation, double stress, double solvent) {
  const BlockSums sums = sum_of(simulation.production().blocks());
  double pairs = 0;
  for (const SymmetricTensor& term : sums.stress) pairs += term.xy;
  const auto steps = static_cast<double>(sums.steps);
  return (pairs / simulation.system().box.volume() + solvent * sums.shear_rate) / steps / stress;
}

const Json for_grains = Json::parse(R"({"fluid": {"thermal_energy": 0},
    "duration": {"equilibration": {"time": null, "stress_times": 10},
                 "production": {"time": null, "stress_times": 40}}})");

class StressControlled : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(EitherMethod, StressControlled, testing::Values("explicit", "implicit"),
                         [](const auto& method) { return std::string(method.param); });

// A step may miss the stress by up to 1 %, or twice that after such a step, and the next steps compensate.
// Over a window only the ends contribute. eta = 0.1, phi = 0.45.
TEST_P(StressControlled, HoldsItsStress) {
  constexpr double stress = 4;
  Json document = at_stress(stress, for_grains);
  document["integrator"]["method"] = GetParam();
  if (GetParam() == std::string("explicit")) document["duration"]["production"]["stress_times"] = 8;
  const auto simulation = started(document);
  const std::optional<Ending> ending = simulation->advance(simulation->schedule().total());
  ASSERT_EQ(ending->cause, Ending::Cause::completed) << ending->message;
  const auto steps = static_cast<double>(simulation->schedule().production);
  EXPECT_NEAR(held(*simulation, stress, 0.1 * (1 + 2.5 * 0.45)), 1, 0.04 / steps);
  EXPECT_GT(simulation->strains().production, 0.1);
}

// Spheres without neighbours: the rate is stress / [eta (1 + 2.5 phi)] from the first step on.
TEST_P(StressControlled, OfFewSpheresFlowsAsTheSolventAndTheirStresslets) {
  constexpr double stress = 2, fraction = 0.02;
  Json document = at_stress(stress, for_grains);
  document["integrator"]["method"] = GetParam();
  document["volume_fraction"] = fraction;
  document["particles"]["count"] = 4;
  const auto simulation = started(document);
  simulation->advance(40);
  const double rate = simulation->system().box.velocity_gradient().column[1].x;
  EXPECT_NEAR(rate, stress / (0.1 * (1 + 2.5 * fraction)), 0.011 * rate);
}

TEST(StressControl, EndsWhatStandsStill) {
  Json document = at_stress(4, for_grains);
  document["flow"]["jammed_viscosity"] = 3;  // below that of any suspension
  const auto simulation = started(document);
  const std::optional<Ending> ending = simulation->advance(simulation->schedule().total());
  EXPECT_EQ(ending->cause, Ending::Cause::jammed);
  EXPECT_LT(simulation->system().step, simulation->schedule().total());
  // Equilibration ends when jamming is noticed; the window lasts as long again, 0.01 eta_j eta / stress.
  EXPECT_GT(simulation->schedule().equilibration, 0u);
  EXPECT_GT(simulation->system().step, simulation->schedule().equilibration);
  EXPECT_NEAR(simulation->schedule().timestep * static_cast<double>(simulation->schedule().equilibration),
              0.01 * 3 * 0.1 / 4, simulation->schedule().timestep);
  // A result exists: the rate in the window is zero, and the summary works.
  const Json result = result_of(document, *simulation, *ending);
  const Json& mean = result.at("mean");
  EXPECT_EQ(mean.at("flowing"), 0);
  EXPECT_GT(simulation->strains().production, 0);
  EXPECT_EQ(mean.at("shear_rate"), 0);
  EXPECT_EQ(mean.at("apparent_viscosity").at("viscous_stress"), 0);
  EXPECT_TRUE(result.at("blocks").at("pressure").front().is_number());
  EXPECT_TRUE(result.at("blocks").at("pressure").back().is_null());
  EXPECT_EQ(result.at("blocks").at("shear_rate").back(), 0);
  EXPECT_TRUE(contains(summary(result, "here"), "jammed at a strain of"));
}

// At eta_j = 10^4 a strain of 0.01 takes 100 stress times; the window has 40.
TEST(StressControl, SaysNothingOfWhatFlowsInAWindowThatEndsBeforeAJamIsNoticed) {
  for (const auto& [viscosity, is_known] : {std::pair{1e4, false}, {4000, false}, {3900, true}}) {
    Json document = at_stress(4, for_grains);
    document["flow"]["jammed_viscosity"] = viscosity;
    const auto simulation = started(document);
    const std::optional<Ending> ending = simulation->advance(simulation->schedule().total());
    const Json result = result_of(document, *simulation, *ending);
    const Json& mean = result.at("mean");
    const Json& flowing = mean.at("viscosity_of_those_flowing");
    EXPECT_EQ(mean.at("flowing"), is_known ? Json(1) : Json());
    EXPECT_EQ(flowing.at("stress"), is_known ? Json(4) : Json());
    EXPECT_EQ(flowing.at("viscous_stress").is_null(), !is_known);
    EXPECT_GT(mean.at("shear_rate"), 0);
    EXPECT_EQ(mean.at("apparent_viscosity").at("stress"), 4);
    bool is_warned = false;
    for (const Json& warning : result.at("warnings")) is_warned |= warning.at("code") == "patience";
    EXPECT_EQ(is_warned, !is_known);
  }
}

// A window that begins at a checkpoint counts the strain from there on.
TEST(StressControl, CountsTheStrainOfALongerRunFromItsOwnWindowOn) {
  const Json document = at_stress(4, for_grains);
  const Scene scene = read_scene(document, "scene.json");
  const Schedule whole = make_schedule(scene, "scene.json");
  const auto first = started(document);
  first->advance(whole.equilibration + 100);
  const std::string saved = bytes_of(*first);
  const Schedule rest = {whole.timestep, whole.equilibration + 100, whole.production - 100};
  Simulation second(scene, rest, 3, 1, "scene.json");
  ArchiveReader reader(saved);
  second.load_motion(reader);
  const double before = second.system().box.strain();
  EXPECT_GT(before, 0);
  second.advance(50);
  EXPECT_EQ(second.strains().equilibration, before);
  EXPECT_EQ(second.strains().production, second.system().box.strain() - before);
}

const Json for_colloids = together({elastic_contacts, Json::parse(R"({
    "particles": {"count": 20}, "volume_fraction": 0.3, "contact": {"normal_stiffness": 1e4},
    "duration": {"equilibration": {"time": null, "brownian_times": 0.2},
                 "production": {"time": null, "brownian_times": 400}}})")});

// <rate^2> M / kT = 1. A memory of 20 steps in 40 000 gives a standard error of about sqrt(2 * 40 / 40 000).
TEST(StressControl, GivesTheStrainItsShareOfTheTemperature) {
  const auto simulation = started(at_stress(1e-9, for_colloids));
  simulation->advance(400);
  const double volume = simulation->system().box.volume(), energy = 0.02;
  double sum = 0;
  constexpr int steps = 160000;
  for (int n = 0; n < steps; ++n) {
    ASSERT_EQ(simulation->advance(1), std::nullopt);
    const double rate = simulation->system().box.velocity_gradient().column[1].x;
    sum += rate * rate;
  }
  const double temperature = sum / steps * inertia_of(*simulation) * volume / energy;
  EXPECT_NEAR(temperature, 1, 3 * std::sqrt(2 * 40.0 / steps));
}

// M / V = 20 dt eta_inf, independent of the stress.
TEST(StressControl, HasTheSameInertiaAtEveryStress) {
  const auto inertia_at = [](double stress) {
    const auto simulation = started(at_stress(stress * 0.02, for_colloids));
    simulation->advance(1);
    return inertia_of(*simulation) / simulation->schedule().timestep;
  };
  const double inertia = inertia_at(1e-9);
  EXPECT_NEAR(inertia_at(1e-3), inertia, 1e-3 * inertia);
  EXPECT_NEAR(inertia_at(1), inertia, 1e-3 * inertia);
}

// At vanishing stress the rate is thermal, sqrt(kT / M), for any packing. At phi = 0.3 the viscosity of fixed
// pairs is at least 1 + 2.5 phi = 1.75. 400 steps give about 20 independent rates: a standard error of 32 %
// per seed, 9 % over twelve.
TEST(StressControl, LetsTheStrainOfEveryPackingMove) {
  Json document = at_stress(1e-9 * 0.02, for_colloids);
  const Scene scene = read_scene(document, "scene.json");
  const Schedule schedule = make_schedule(scene, "scene.json");
  constexpr int seeds = 12;
  double temperature = 0;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    Simulation simulation = engine::started(scene, seed);
    double squares = 0;
    constexpr int steps = 400;
    for (int n = 0; n < steps; ++n) {
      ASSERT_EQ(simulation.advance(1), std::nullopt);
      squares += std::pow(simulation.system().box.velocity_gradient().column[1].x, 2) / steps;
    }
    const double volume = simulation.system().box.volume();
    const double inertia = inertia_of(simulation);
    EXPECT_GT(inertia / (20 * schedule.timestep * 0.1), 1.75) << "seed " << seed;
    EXPECT_LT(inertia / (20 * schedule.timestep * 0.1), 10) << "seed " << seed;
    temperature += squares * volume * inertia / (0.02 * seeds);
  }
  EXPECT_NEAR(temperature, 1, 0.3);
}

class ResumedAtStress : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(WithAndWithoutNoise, ResumedAtStress, testing::Bool());

TEST_P(ResumedAtStress, EndsAsTheUncutOneWhereverItWasCut) {
  Json document = GetParam() ? at_stress(4, for_colloids) : at_stress(4, for_grains);
  document["duration"] = {{"equilibration", {{"stress_times", 2}}}, {"production", {{"stress_times", 6}}}};
  document["observables"] = {"contact_network", "pair_distribution"};
  document["pair_distribution"] = {{"range", 2.5}};
  const Scene scene = read_scene(document, "scene.json");
  const std::uint64_t total = make_schedule(scene, "scene.json").total();
  expect_the_end_of_the_uncut(scene, 3, {{0, 1}, {1, 1}, {total / 5, 1}, {total / 4 + 1, 1}, {total - 1, 2}});
}

}  // namespace
}  // namespace peclet::engine
