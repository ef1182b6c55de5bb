// The response to a step that is too large for the packing, and the step's errors in the result.
#include <gtest/gtest.h>

#include "engine/integrators/stability.h"
#include "engine/integrators/velocity_verlet.h"
#include "tests/engine/realisation/small_result.h"

namespace peclet::engine {
namespace {

// Returns the published parameters without noise. Scenes of any step and guard have the same packing.
Json published(double volume_fraction) {
  Json scene = Json::parse(R"({
    "particles": {"count": 60, "density": 0.1,
                  "species": [{"radius": 1, "volume_share": 1}, {"radius": 1.4, "volume_share": 1}]},
    "seeds_in_common": true,
    "fluid": {"viscosity": 0.1},
    "flow": {"shear_rate": 0.045},
    "contact": {"normal_stiffness": 1e4},
    "lubrication": {"form": "kim-karrila"},
    "integrator": {"method": "explicit"},
    "duration": {"equilibration": {"strain": 0}, "production": {"strain": 1}}})");
  scene["volume_fraction"] = volume_fraction;
  return scene;
}

Scene published_scene(double volume_fraction) { return read_scene(published(volume_fraction), "scene.json"); }

// Starts with a given step, which make_schedule() might refuse.
Simulation started_with(const Scene& scene, const Schedule& schedule) {
  Simulation simulation(scene, schedule, /*seed=*/1, /*threads=*/1, "scene.json");
  simulation.start();
  return simulation;
}

double named_bound(const Ending& ending) {
  double bound = 0;
  EXPECT_EQ(std::sscanf(ending.message.substr(ending.message.find("allows")).c_str(), "allows %lf", &bound),
            1)
      << ending.message;
  return bound;
}

TEST(StepGate, EndsARealisationThatIsTooStiffAtItsStart) {
  const Scene scene = published_scene(0.6);
  const double step = 2 * largest_timestep(scene);
  Simulation simulation = started_with(scene, {step, 0, 1000});
  const std::optional<Ending> ending = simulation.advance(1000);
  ASSERT_TRUE(ending.has_value());
  EXPECT_EQ(ending->cause, Ending::Cause::timestep);
  EXPECT_STREQ(name_of(ending->cause), "timestep");
  EXPECT_EQ(ending->step, 0u);
  EXPECT_GE(simulation.step_errors().largest_stability_share, 1);
  EXPECT_LT(named_bound(*ending), step);
  // The bound in the message is sufficient.
  Simulation slower = started_with(scene, {0.999 * named_bound(*ending), 0, 1000});
  EXPECT_FALSE(slower.advance(10).has_value());
}

// The packing gets denser locally with time. A resumed realisation ends like an uninterrupted one.
TEST(StepGate, EndsARealisationWhosePackingGetsTooStiffOnItsWay) {
  const Scene scene = published_scene(0.5);
  const Schedule schedule = {4.2e-4, 0, 40000};
  Simulation simulation = started_with(scene, schedule);
  ASSERT_FALSE(simulation.advance(6000).has_value());
  EXPECT_LT(simulation.step_errors().largest_stability_share, 1);
  const std::string checkpoint = bytes_of(simulation);
  const std::optional<Ending> ending = simulation.advance(40000);
  ASSERT_TRUE(ending.has_value());
  EXPECT_EQ(ending->cause, Ending::Cause::timestep);
  EXPECT_GT(ending->step, 6000u);
  EXPECT_TRUE(contains(ending->message, "strain"));

  Simulation resumed(scene, schedule, 1, 1, "scene.json");
  load(resumed, checkpoint);
  const std::optional<Ending> again = resumed.advance(40000);
  ASSERT_TRUE(again.has_value());
  EXPECT_EQ(again->step, ending->step);
  EXPECT_EQ(again->message, ending->message);
  EXPECT_EQ(resumed.step_errors().spurious_energy, simulation.step_errors().spurious_energy);
}

bool has_warning(const Json& result, const std::string& code) {
  for (const Json& warning : result.at("warnings")) {
    if (warning.at("code") == code) return true;
  }
  return false;
}

// The error is of first order in the step, as from velocities half a step old in velocity Verlet.
TEST(StepGate, EnergyThatTheStepMakesIsInProportionToIt) {
  const auto imbalance = [](double step) {
    Json scene = published(0.55);
    scene["integrator"]["timestep"] = step;
    scene["duration"] = {{"equilibration", {{"strain", 0.1}}}, {"production", {{"strain", 0.3}}}};
    return result_of_scene(scene).at("gate").at("energy_imbalance").get<double>();
  };
  const double whole = imbalance(2e-4), half = imbalance(1e-4);
  EXPECT_GT(whole, 0);
  EXPECT_NEAR(half / whole, 0.5, 0.1);
}

TEST(StepGate, FlagsAResultWhoseStepMakesTooMuchEnergy) {
  EXPECT_FALSE(has_warning(result_of(without_noise), "timestep"));
  const Json flagged = result_of(together({without_noise, {{"guard", {{"energy_imbalance", 1e-6}}}}}));
  EXPECT_TRUE(has_warning(flagged, "timestep"));
  EXPECT_EQ(flagged.at("ending").at("cause"), "completed");
  EXPECT_TRUE(flagged.at("mean").is_object());
}

// The comparison follows the steps that the system takes next, bit by bit. Above the stable step, whole steps
// diverge from half steps.
TEST(StepGate, StepsAreComparedWithHalfStepsOfTheSameMotion) {
  constexpr int steps = 200;
  Json document = published(0.55);
  document["contact"]["friction"] = 1;
  const Scene scene = read_scene(document, "scene.json");
  Simulation simulation = started_with(scene, {1e-4, 40000, 40000});
  simulation.advance(20000);
  const auto compared = [&](int factor) {
    const double timestep = factor * 1e-4;
    System system = simulation.system();
    VelocityVerlet integrator(ForceField(scene.physics, system.particles, timestep, 1, 1), system.particles,
                              timestep);
    integrator.start(system);
    integrator.advance(system);
    const Integrator::HalfSteps half_steps = integrator.compare_half_steps(system, steps);
    double sum = 0;
    for (int step = 0; step < steps; ++step) {
      for (const SymmetricTensor& stress : integrator.advance(system).sums.stress) sum += stress.xy;
    }
    EXPECT_EQ(half_steps.whole, sum);
    return half_steps.whole / half_steps.halved - 1;
  };
  const double stable = compared(1), unstable = compared(5);
  EXPECT_LT(std::abs(stable), 1e-3);
  EXPECT_GT(std::abs(unstable), 0.03);
}

TEST(StepGate, FlagsAResultThatHalfStepsWouldChange) {
  const auto result = [](const Json& guard) {
    Json scene = published(0.5);
    scene["guard"] = guard;
    scene["duration"] = {{"equilibration", {{"strain", 0.1}}}, {"production", {{"strain", 0.2}}}};
    return result_of_scene(scene);
  };
  const Json fine = result(Json::object());
  EXPECT_FALSE(has_warning(fine, "timestep"));
  EXPECT_LT(std::abs(fine.at("gate").at("half_step_difference").get<double>()), 0.001);
  const Json flagged = result({{"half_step_difference", 1e-12}});
  EXPECT_TRUE(has_warning(flagged, "timestep"));
  EXPECT_EQ(flagged.at("mean"), fine.at("mean"));
}

// Cases: a step beyond the known error with noise; a cut-off of a strong repulsion, which leaves equations
// without a solution; mostly divided steps.
TEST(StepGate, FlagsImplicitSteps) {
  const auto result = [](Json scene, const Json& patch) {
    scene.merge_patch(
        {{"integrator", {{"method", "implicit"}}},
         {"duration", {{"equilibration", {{"strain", 0.1}}}, {"production", {{"strain", 0.5}}}}}});
    scene.merge_patch(patch);
    return result_of_scene(scene);
  };
  const Json fine = result(published(0.5), Json::object());
  EXPECT_FALSE(has_warning(fine, "timestep"));
  EXPECT_FALSE(has_warning(fine, "solver"));
  EXPECT_GT(fine.at("gate").at("solver").at("iterations_per_step"), 1);
  EXPECT_EQ(fine.at("gate").at("solver").at("divided_steps"), 0);
  EXPECT_EQ(fine.at("gate").at("solver").at("deepest_division"), 0);
  const Json edge = {
      {"repulsion",
       {{"form", "exponential"}, {"strength", 100}, {"relative_length", 0.01}, {"cutoff_lengths", 5}}},
      {"duration", {{"production", {{"strain", 0.05}}}}}};
  EXPECT_TRUE(has_warning(result(published(0.5), edge), "solver"));
  const Json divided = result(published(0.5), {{"guard", {{"largest_displacement", 0.02}}}});
  EXPECT_TRUE(has_warning(divided, "timestep"));
  const Json& solver = divided.at("gate").at("solver");
  EXPECT_GT(solver.at("divided_steps"), 0.1 * divided.at("steps").at("production").get<double>());
  EXPECT_LE(solver.at("divided_steps"), divided.at("steps").at("production"));
  EXPECT_GT(solver.at("deepest_division"), 0);

  Json warm = published(0.5);
  warm["fluid"]["thermal_energy"] = 0.01;
  const double automatic = 0.0045 * 0.1 / 0.01;
  EXPECT_FALSE(has_warning(result(warm, {{"integrator", {{"timestep", 0.99 * automatic}}}}), "timestep"));
  EXPECT_TRUE(has_warning(result(warm, {{"integrator", {{"timestep", 1.01 * automatic}}}}), "timestep"));
}

TEST(StepGate, NoiseAndRestHaveNoBalance) {
  const Json noisy = result_of(Json::object()).at("gate");
  EXPECT_TRUE(noisy.at("energy_imbalance").is_null());
  EXPECT_TRUE(noisy.at("half_step_difference").is_null());
  EXPECT_GT(noisy.at("largest_stability_share"), 0);
  EXPECT_LT(noisy.at("largest_stability_share"), 1);
  const Json resting = result_of(together({without_noise, at_rest})).at("gate");
  EXPECT_TRUE(resting.at("energy_imbalance").is_null());
  EXPECT_TRUE(resting.at("half_step_difference").is_null());
}

TEST(StepGate, OfSpheresThatWereNotPackedThereIsNothingToSay) {
  const Json result = result_of({{"volume_fraction", 0.73}, {"particles", {{"count", 20}}}});
  EXPECT_TRUE(result.at("gate").is_null());
}

}  // namespace
}  // namespace peclet::engine
