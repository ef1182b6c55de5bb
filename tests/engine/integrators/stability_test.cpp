#include "engine/integrators/stability.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <numbers>

#include "contract/errors.h"
#include "engine/observables/scene_reading.h"
#include "engine/observables/structure.h"
#include "engine/realisation/packing.h"
#include "tests/engine/draws.h"
#include "tests/engine/few_spheres.h"

namespace peclet::engine {
namespace {

using std::numbers::pi;

// Table 4.1 of Li (2023): a = 1 and 1.4, rho = eta = 0.1, k_n = 1e4, gaps 1e-3 to 0.05.
Json published_scene() {
  return Json::parse(R"({
    "particles": {"count": 200, "density": 0.1,
                  "species": [{"radius": 1, "volume_share": 1}, {"radius": 1.4, "volume_share": 1}]},
    "volume_fraction": 0.6,
    "fluid": {"viscosity": 0.1},
    "flow": {"shear_rate": 0.009},
    "contact": {"normal_stiffness": 1e4},
    "lubrication": {"form": "kim-karrila"},
    "integrator": {"method": "explicit"},
    "duration": {"equilibration": {"strain": 2}, "production": {"strain": 5}}})");
}

Scene scene_with(const Json& patch) {
  Json document = published_scene();
  document.merge_patch(patch);
  return read_scene(document, "scene.json");
}

// Returns the root of w^2 dt^2 + 2 l dt = 4 by bisection; shares no formula with the engine.
double root(double w2, double l) {
  double low = 0, high = 2 / l;
  for (int k = 0; k < 200; ++k) {
    const double middle = 0.5 * (low + high);
    (w2 * middle * middle + 2 * l * middle < 4 ? low : high) = middle;
  }
  return low;
}

// Returns the damping rate and the largest stable step of a pair of these spheres, whose X_A is `resistance`
// in units of the drag. The factor for the densest packings is 2.8.
double damping_of_pair(double radius, double resistance) {
  return 6 * pi * 0.1 * radius * (2 * resistance + 1) / (4 * pi / 3 * 0.1 * std::pow(radius, 3));
}
double largest_of_pair(double radius, double resistance) {
  const double frequency_squared = 2 * 1e4 / (4 * pi / 3 * 0.1 * std::pow(radius, 3));
  return root(2.8 * frequency_squared, 2.8 * damping_of_pair(radius, resistance));
}

// Two of the smallest spheres set the step: X_A = 251.55 * 6 pi eta a at the inner gap (published), both
// masses 0.4189.
TEST(Stability, StepOfThePublishedSceneIsTheRootOfItsStiffestPair) {
  const Scene scene = scene_with(Json::object());
  EXPECT_NEAR(damping_of_pair(1, 251.55), 2264 + 4.5, 1);
  EXPECT_NEAR(largest_timestep(scene) / largest_of_pair(1, 251.55), 1, 1e-4);
  EXPECT_NEAR(automatic_timestep(scene).value / largest_of_pair(1, 251.55), 0.5, 1e-4);
  EXPECT_NEAR(automatic_timestep(scene).value, 1.57e-4, 0.005e-4);
  EXPECT_EQ(automatic_timestep(scene).limit, std::string("stability"));
  EXPECT_EQ(resolved_timestep(scene, "scene.json").value, automatic_timestep(scene).value);
}

// Small spheres of four times the density are no longer the stiffest pair. Two large ones are, of mass 4
// pi / 3 0.1 1.4^3 and X_A = 251.55 * 6 pi eta 1.4.
TEST(Stability, StepIsOfTheLightestPairForItsResistance) {
  const Scene scene = scene_with(Json::parse(R"({"particles": {"species": [
      {"radius": 1, "volume_share": 1, "density": 0.4}, {"radius": 1.4, "volume_share": 1}]}})"));
  EXPECT_NEAR(largest_timestep(scene) / largest_of_pair(1.4, 251.55), 1, 1e-4);
}

// A strain of 0.01 over 1 + 2 St, St = rho_i a_i^2 rate / eta of the densest species here, not the largest.
TEST(Stability, ImplicitStepKnowsTheInertiaOfEachSpecies) {
  const auto step = [](double density) {
    Json patch = {{"volume_fraction", 0.4},
                  {"contact", nullptr},
                  {"flow", {{"shear_rate", 1}}},
                  {"integrator", {{"method", "implicit"}}}};
    patch["particles"]["species"] = {{{"radius", 1}, {"volume_share", 1}, {"density", density}},
                                     {{"radius", 1.4}, {"volume_share", 1}}};
    return automatic_timestep(scene_with(patch)).value;
  };
  EXPECT_NEAR(step(0.1), 0.01 / (1 + 2 * 1.96), 1e-12);
  EXPECT_NEAR(step(0.3), 0.01 / (1 + 2 * 3), 1e-12);
}

// The form mari has X_A = 6 pi eta a / (4 eps) at contact.
TEST(Stability, StepOfLubricationRelativeToTheFlowIsThatOfItsRegularisation) {
  const Scene scene =
      scene_with({{"lubrication", {{"form", "mari"}, {"regularisation", 2e-3}, {"outer_distance", 0.2}}}});
  EXPECT_NEAR(automatic_timestep(scene).value / (0.5 * largest_of_pair(1, 125)), 1, 1e-10);
}

TEST(Stability, AGivenStepUpToTheBoundIsTakenAsItIs) {
  const double largest = largest_timestep(scene_with(Json::object()));
  const Scene scene = scene_with({{"integrator", {{"timestep", 0.999 * largest}}}});
  EXPECT_EQ(resolved_timestep(scene, "scene.json").value, 0.999 * largest);
}

TEST(Stability, AStepBeyondIsRefusedWithTheBound) {
  const double largest = largest_timestep(scene_with(Json::object()));
  const Scene scene = scene_with({{"integrator", {{"timestep", 1.001 * largest}}}});
  try {
    resolved_timestep(scene, "scene.json");
    ADD_FAILURE() << "accepted";
  } catch (const InputError& error) {
    EXPECT_EQ(error.file(), "scene.json");
    EXPECT_EQ(error.pointer(), "/integrator/timestep");
    EXPECT_DOUBLE_EQ(std::stod(error.value()), 1.001 * largest);
    double bound = 0;
    EXPECT_EQ(std::sscanf(error.allowed().c_str(), "must be at most %lf", &bound), 1) << error.allowed();
    EXPECT_NEAR(bound / largest, 1, 1e-3);
  }
}

// Rates of a pair, part by part: springs by k (1/m + 1/m), tangential springs 7/2 of that.
TEST(Stability, EveryPartOfTheSceneCounts) {
  const double mobility = 2 / (4 * pi / 3 * 0.1);
  const PairRates plain = stiffest_pair(scene_with(Json::object()));
  const auto rates = [](const Json& patch) { return stiffest_pair(scene_with(patch)); };
  const Json stiff_tangent = {{"contact", {{"friction", 0.5}, {"tangential_stiffness", 1e4}}}};
  EXPECT_NEAR(rates(stiff_tangent).frequency_squared / plain.frequency_squared, 3.5, 1e-12);
  EXPECT_NEAR(rates({{"contact", {{"normal_damping", 3}}}}).damping - plain.damping, 3 * mobility, 1e-8);
  const auto damped = [](double damping) {
    return Json{{"contact", {{"friction", 0.5}, {"tangential_damping", damping}}}};
  };
  EXPECT_NEAR(rates(damped(3e3)).damping - rates(damped(2e3)).damping, 3.5e3 * mobility, 1e-6);
  const Json repulsion = {
      {"repulsion", {{"form", "exponential"}, {"strength", 1.7}, {"relative_length", 0.01}}}};
  EXPECT_NEAR(rates(repulsion).frequency_squared - plain.frequency_squared, 1.7 / 4e-4 * mobility, 1e-4);
  // Attraction at its steepest distance, eps / sqrt(3).
  const Json attraction = {{"attraction", {{"hamaker", 0.6}, {"regularisation", 0.01}, {"cutoff", 1}}}};
  const double steepest = 9 / (8 * std::sqrt(3.0)) * 0.05 / 1e-6;
  EXPECT_NEAR(rates(attraction).frequency_squared - plain.frequency_squared, steepest * mobility, 1e-3);
}

// A packing compressed by 0.5 %, so that most near pairs overlap or touch, and nearly at rest. Too long a
// step makes a disturbance grow without bound.
class PressedPacking {
 public:
  explicit PressedPacking(const Scene& scene) : scene_(scene) {
    const std::vector<double> radius = species_radii(scene.particles);
    const double edge = cube_edge(radius, scene.volume_fraction);
    system_ = spheres_in({edge, edge, edge}, scene.physics, radius, scene.particles.density);
    place_randomly(system_.particles, system_.box, 1);
    constexpr double pressed = 0.995;
    for (std::size_t i = 0; i < radius.size(); ++i) {
      system_.particles.position.set(i, pressed * system_.particles.position[i]);
    }
    system_.box = PeriodicCell({pressed * edge, pressed * edge, pressed * edge}, Matrix3{});
    run(system_, 0.2 * largest_timestep(scene), 1000);
  }

  // Returns the growth factor of random disturbances of velocities and spins over `steps` steps.
  double growth(double timestep, int steps) const {
    System plain = system_, disturbed = system_;
    Draws draws(1);
    for (std::size_t i = 0; i < plain.particles.count(); ++i) {
      disturbed.particles.velocity.set(i, plain.particles.velocity[i] + draws.vector(1e-9));
      disturbed.particles.angular_velocity.set(i, plain.particles.angular_velocity[i] + draws.vector(1e-9));
    }
    const double first = difference(plain, disturbed);
    return run(plain, timestep, steps) && run(disturbed, timestep, steps)
               ? difference(plain, disturbed) / first
               : std::numeric_limits<double>::infinity();
  }

 private:
  bool run(System& system, double timestep, int steps) const {
    VelocityVerlet integrator = explicit_steps(scene_.physics, system, timestep);
    integrator.start(system);
    for (int step = 0; step < steps; ++step) {
      if (!(integrator.advance(system).largest_displacement < 0.05)) return false;
    }
    return true;
  }

  static double difference(const System& a, const System& b) {
    double largest = 0;
    for (std::size_t i = 0; i < a.particles.count(); ++i) {
      largest = std::max({largest, norm(a.particles.velocity[i] - b.particles.velocity[i]),
                          norm(a.particles.angular_velocity[i] - b.particles.angular_velocity[i])});
    }
    return largest;
  }

  const Scene& scene_;
  System system_;
};

Scene at_rest(Json patch) {
  patch["flow"] = {{"shear_rate", 0}};
  patch["duration"] = Json::parse(
      R"({"equilibration": {"strain": null, "time": 1}, "production": {"strain": null, "time": 1}})");
  return scene_with(patch);
}

// At three times the largest step the published packing explodes.
TEST(Stability, ThePublishedPackingIsStableAtTheLargestStepAndExplodesNotFarBeyond) {
  const Scene scene = at_rest(Json::object());
  const PressedPacking packing(scene);
  EXPECT_LT(packing.growth(largest_timestep(scene), 300), 1);
  EXPECT_GT(packing.growth(3 * largest_timestep(scene), 300), 1e3);
}

// Spins are damped faster than velocities, 20 pi eta a / m against 6 pi eta a / m. They set the step without
// contact and with weak lubrication.
TEST(Stability, SpinsAreStableAtTheLargestStep) {
  for (const Json& lubrication : {Json(), Json::parse(R"({"inner_gap": 0.5, "outer_gap": 0.6})")}) {
    const Scene scene = at_rest({{"lubrication", lubrication}, {"contact", nullptr}});
    EXPECT_LT(PressedPacking(scene).growth(largest_timestep(scene), 300), 1) << lubrication;
  }
}

// The more viscous fluid keeps frictionless spheres from chaotic collisions; contacts still limit the step.
TEST(Stability, TheAutomaticStepIsStableWhateverLimitsIt) {
  const Json thick = {{"viscosity", 1}};
  const struct {
    const char* limited_by;
    Json patch;
  } scenes[] = {
      {"lubrication at a wide inner gap", {{"lubrication", {{"inner_gap", 0.04}}}, {"contact", nullptr}}},
      {"lubrication relative to the flow",
       {{"lubrication", {{"form", "mari"}, {"outer_distance", 0.2}}}, {"contact", nullptr}}},
      {"drag and soft contacts", {{"lubrication", nullptr}, {"contact", {{"normal_stiffness", 1}}}}},
      {"contacts", {{"lubrication", nullptr}, {"fluid", thick}}},
      {"contacts with friction",
       {{"lubrication", nullptr}, {"fluid", thick}, {"contact", {{"friction", 1}}}}},
      {"contacts with stiff friction",
       {{"lubrication", nullptr},
        {"fluid", thick},
        {"contact", {{"friction", 1}, {"tangential_stiffness", 1e4}}}}},
      {"damped contacts",
       {{"lubrication", nullptr}, {"contact", {{"normal_damping", 100}, {"normal_stiffness", 1e4}}}}},
      {"repulsion",
       {{"lubrication", nullptr},
        {"fluid", thick},
        {"repulsion", {{"form", "exponential"}, {"strength", 1.7}, {"relative_length", 0.01}}}}},
  };
  for (const auto& each : scenes) {
    const Scene scene = at_rest(each.patch);
    EXPECT_LT(PressedPacking(scene).growth(automatic_timestep(scene).value, 300), 5) << each.limited_by;
  }
}

}  // namespace
}  // namespace peclet::engine
