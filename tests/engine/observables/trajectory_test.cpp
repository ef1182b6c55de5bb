// Frames of a trajectory compared with the realisation: positions, motion, stress, contacts.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "engine/observables/observable.h"
#include "tests/engine/realisation/small_result.h"
#include "tests/engine/snapshots/gsd_reader.h"

namespace peclet::engine {
namespace {

constexpr std::uint64_t equilibration = 100, production = 320;
constexpr double rounding = 0x1p-24;  // to the nearest float, relative

Json scene_with_trajectory(const Json& patch = Json::object(), const Json& interval = {{"time", 0.002}}) {
  Json scene = small_scene(
      {{"observables", {"trajectory"}}, {"trajectory", {{"interval", interval}, {"contacts", true}}}});
  scene.merge_patch(patch);
  return scene;
}

Simulation started(const Json& document, int threads = 1) {
  return engine::started(read_scene(document, "scene.json"), 3, threads);
}

GsdReader file_of(Simulation& simulation) {
  const gsd::Frames& frames = *simulation.frames();
  return GsdReader(frames.head() + frames.pending() + frames.tail());
}

struct Way {
  const char* name;
  Json patch;
};
Json dividing_at(double displacement) { return {{"guard", {{"largest_displacement", displacement}}}}; }
const Json waves = Json::parse(R"({"flow": {"waves": [{"periods": 1, "sine": 0.4}], "faxen": true}})");
const Way ways[] = {
    {"explicit", Json::object()},
    {"implicit", implicit_and_light},
    {"implicit_without_noise", together({implicit_and_light, without_noise})},
    {"implicit_with_divided_steps", together({implicit_and_light, dividing_at(0.01)})},
    {"implicit_without_noise_with_divided_steps",
     together({implicit_and_light, without_noise, dividing_at(0.04)})},
    {"explicit_in_waves", together({waves, strained_lubrication})},
};

class TrajectoryStress : public testing::TestWithParam<Way> {};
INSTANTIATE_TEST_SUITE_P(EveryWay, TrajectoryStress, testing::ValuesIn(ways),
                         [](const auto& way) { return std::string(way.param.name); });

// V (total - solvent) is the sum over the spheres, each rounded to a float.
TEST_P(TrajectoryStress, OfTheSpheresAddsUpToThatOfTheFrame) {
  Simulation simulation = started(scene_with_trajectory(GetParam().patch));
  ASSERT_EQ(simulation.advance(equilibration + production)->cause, Ending::Cause::completed);
  const GsdReader file = file_of(simulation);
  ASSERT_EQ(file.frames(), production);
  const double volume = simulation.system().box.volume();
  double largest = 0;
  for (std::uint64_t k = 0; k < production; ++k) {
    const auto of_spheres = file.get<float>(k, "log/particles/stress");
    const auto total = file.get<double>(k, "log/stress/total"),
               solvent = file.get<double>(k, "log/stress/solvent");
    for (std::size_t c = 0; c < 6; ++c) {
      double sum = 0, sizes = 0;
      for (std::size_t i = c; i < of_spheres.size(); i += 6) {
        sum += of_spheres[i];
        sizes += std::abs(of_spheres[i]);
      }
      EXPECT_NEAR(sum, volume * (total[c] - solvent[c]), 1.01 * rounding * sizes) << "frame " << k;
      largest = std::max(largest, std::abs(sum));
    }
  }
  EXPECT_GT(largest, 0);
  const bool divides = std::string(GetParam().name).ends_with("divided_steps");
  EXPECT_EQ(simulation.step_errors().divided_steps > 50, divides);
}

// Frames at all steps have the mean of the window.
TEST_P(TrajectoryStress, HasTheMeanOfTheResult) {
  Simulation simulation = started(scene_with_trajectory(GetParam().patch));
  simulation.advance(equilibration + production);
  const GsdReader file = file_of(simulation);
  const BlockSums window = sum_of(simulation.production().blocks());
  std::set<std::string> terms;
  for (const std::string& name : file.names()) {
    if (name.starts_with("log/stress/")) terms.insert(name);
  }
  for (const char* alone : {"total", "solvent", "stresslet"})
    EXPECT_EQ(terms.erase(std::string("log/stress/") + alone), 1U);
  EXPECT_GE(terms.size(), 5U);
  for (const std::string& name : terms) {
    std::optional<StressTerm> term;
    for (std::size_t t = 0; t < count_of_stress_terms; ++t) {
      if (name == std::string("log/stress/") + stress_parts[t].name) term = static_cast<StressTerm>(t);
    }
    ASSERT_TRUE(term || name == "log/stress/motion") << name;
    double xy = 0;
    for (std::uint64_t k = 0; k < production; ++k) xy += file.get<double>(k, name)[3] / production;
    const SymmetricTensor& sum = term ? window.stress[static_cast<std::size_t>(*term)] : window.motion;
    const double expected = sum.xy / (production * simulation.system().box.volume());
    EXPECT_NEAR(xy, expected, 1e-11 * (std::abs(expected) + 1e-3)) << name;
  }
}

// The result samples the stresslets of waves every ten explicit steps; frames have them at every step. In
// uniform shear gamma they are 2.5 phi eta gamma.
TEST(TrajectoryStress, HasTheStressletsOfWaves) {
  const Way& waves = ways[std::size(ways) - 1];
  ASSERT_EQ(std::string(waves.name), "explicit_in_waves");
  Simulation simulation = started(scene_with_trajectory(waves.patch));
  simulation.advance(equilibration + production);
  const GsdReader file = file_of(simulation);
  const BlockSums window = sum_of(simulation.production().blocks());
  constexpr std::uint64_t interval = 10, samples = production / interval;
  ASSERT_EQ(window.samples, samples);
  double xy = 0;
  for (std::uint64_t k = 0; k < production; k += interval) {
    xy += file.get<double>(k, "log/stress/stresslet")[3] / samples;
  }
  const double of_waves = window.varying_stresslet.xy / samples, uniform = 2.5 * 0.45 * 0.1 * 2;
  EXPECT_GT(std::abs(of_waves), 1e-5);  // large enough to matter
  EXPECT_NEAR(xy, uniform + of_waves, 1e-11);
}

// Through three changes of basis each sphere moves by the displacement of its unwrapped position.
TEST(Trajectory, HasPlacesAndMotionOfEverySphereInTheCell) {
  Simulation simulation = started(scene_with_trajectory());
  simulation.advance(equilibration);
  std::set<std::int32_t> bases;
  std::vector<System> systems;
  for (std::uint64_t k = 0; k < production; ++k) {
    simulation.advance(1);
    systems.push_back(simulation.system());
    bases.insert(simulation.system().box.basis().column[1].x);
  }
  EXPECT_GE(bases.size(), 2U);
  const GsdReader file = file_of(simulation);
  std::uint64_t wrapped = 0;
  for (std::uint64_t k = 0; k < production; ++k) {
    const System& system = systems[k];
    const ParticleState& particles = system.particles;
    EXPECT_EQ(file.get<std::uint64_t>(k, "configuration/step"), std::vector{equilibration + 1 + k});
    EXPECT_EQ(file.get<double>(k, "log/time"), std::vector{system.clock.time()});
    EXPECT_EQ(file.get<double>(k, "log/strain"), std::vector{system.box.strain()});
    const Matrix3& edges = system.box.edges();
    const double lx = edges.column[0].x, ly = edges.column[1].y, lz = edges.column[2].z;
    const double tilt = edges.column[1].x / ly;
    const auto f = [](double x) { return static_cast<float>(x); };
    EXPECT_EQ(file.get<float>(k, "configuration/box"),
              (std::vector<float>{f(lx), f(ly), f(lz), f(tilt), 0, 0}));
    const auto position = file.get<float>(k, "particles/position"),
               velocity = file.get<float>(k, "particles/velocity"),
               spin = file.get<float>(k, "log/particles/angular_velocity");
    const auto image = file.get<std::int32_t>(k, "particles/image");
    for (std::size_t i = 0; i < particles.count(); ++i) {
      const std::size_t at = 3 * std::size_t{particles.id[i]};
      // Wrapped by whole cells into [-1/2, 1/2).
      const double y = position[at + 1] / ly, x = (position[at] - tilt * ly * y) / lx;
      for (const double fraction : {x, y, position[at + 2] / lz}) EXPECT_LE(std::abs(fraction), 0.5 + 1e-6);
      const LatticeShift shift = {image[at], image[at + 1], image[at + 2]};
      const LatticeShift removed = shift - particles.image[i];
      wrapped += removed == LatticeShift{} ? 0 : 1;
      const Vector3 place =
          particles.position[i] - edges * Vector3{double(removed.x), double(removed.y), double(removed.z)};
      EXPECT_EQ(position[at], f(place.x));
      EXPECT_EQ(position[at + 1], f(place.y));
      EXPECT_EQ(position[at + 2], f(place.z));
      // An image n Ly higher moves faster by n rate Ly.
      EXPECT_EQ(velocity[at], f(particles.velocity[i].x - 2 * ly * removed.y)) << "rate 2";
      EXPECT_EQ(velocity[at + 1], f(particles.velocity[i].y));
      EXPECT_EQ(spin[at + 2], f(particles.angular_velocity[i].z));
    }
  }
  EXPECT_GT(wrapped, 1000U);
}

// The cell of an extension or a cross shear rotates, with basis changes. log/axes maps to its axes.
TEST(Trajectory, HasPlacesAndMotionAlongTheAxesOfATurnedCell) {
  const Json extension = Json::parse(R"({"shear_rate": null, "extension_rate": 2})");
  const Json across = Json::parse(R"({"shear_rate": 2, "cross_shear": {"amplitude": 0.3, "frequency": 10}})");
  const Json uniaxial = Json::parse(R"({"shear_rate": null, "uniaxial_rate": 2})");
  for (const Json& flow : {extension, uniaxial, across}) {
    Simulation simulation = started(scene_with_trajectory({{"flow", flow}, {"volume_fraction", 0.3}}));
    const Schedule schedule = simulation.schedule();
    simulation.advance(schedule.equilibration);
    std::vector<System> systems;
    for (std::uint64_t k = 0; k < schedule.production; ++k) {
      const std::optional<Ending> ending = simulation.advance(1);
      ASSERT_TRUE(!ending || ending->cause == Ending::Cause::completed) << ending->message;
      systems.push_back(simulation.system());
    }
    const GsdReader file = file_of(simulation);
    double largest_turn = 0;
    for (std::uint64_t k = 0; k < schedule.production; ++k) {
      const System& system = systems[k];
      const Matrix3& edges = system.box.edges();
      const auto rows = file.get<double>(k, "log/axes");
      ASSERT_EQ(rows.size(), 9U);
      const Matrix3 axes = {
          Vector3{rows[0], rows[1], rows[2]}, {rows[3], rows[4], rows[5]}, {rows[6], rows[7], rows[8]}};
      EXPECT_NEAR(determinant(axes), 1, 1e-12) << "no mirror";
      largest_turn = std::max(largest_turn, std::acos(std::min(axes.column[1].y, 1.0)));
      const auto box = file.get<float>(k, "configuration/box");
      const Matrix3 lattice = {Vector3{box[0], 0, 0}, Vector3{box[3] * box[1], box[1], 0},
                               Vector3{box[4] * box[2], box[5] * box[2], box[2]}};
      for (std::size_t c = 0; c < 3; ++c) {
        EXPECT_LT(norm(axes * lattice.column[c] - edges.column[c]), 1e-5) << "frame " << k;
      }
      const double time = system.clock.time();
      EXPECT_NEAR(file.get<double>(k, "log/strain").front(), 2 * time, 1e-9);
      const auto position = file.get<float>(k, "particles/position"),
                 velocity = file.get<float>(k, "particles/velocity"),
                 spin = file.get<float>(k, "log/particles/angular_velocity");
      const auto image = file.get<std::int32_t>(k, "particles/image");
      const ParticleState& particles = system.particles;
      for (std::size_t i = 0; i < particles.count(); ++i) {
        const std::size_t at = 3 * std::size_t{particles.id[i]};
        const auto vector = [at](const auto& all) {
          return Vector3{double(all[at]), double(all[at + 1]), double(all[at + 2])};
        };
        const LatticeShift shift = {image[at], image[at + 1], image[at + 2]};
        const LatticeShift removed = shift - particles.image[i];
        const Vector3 back = edges * Vector3{double(removed.x), double(removed.y), double(removed.z)};
        EXPECT_LT(norm(axes * vector(position) + back - particles.position[i]), 1e-5);
        const Vector3 streamed = system.box.velocity_gradient() * back;
        EXPECT_LT(norm(axes * vector(velocity) + streamed - particles.velocity[i]), 1e-4);
        EXPECT_LT(norm(axes * vector(spin) - particles.angular_velocity[i]), 1e-4);
      }
    }
    EXPECT_GT(largest_turn, 0.2);
  }
}

TEST(Trajectory, HasKindsOfSpheresInItsFirstFrame) {
  Simulation simulation = started(scene_with_trajectory());
  simulation.advance(equilibration + 3);
  const GsdReader file = file_of(simulation);
  // Radii share the volume equally, so numbers are as 1.4^3 to 1 of 60.
  const std::size_t small = 44;
  const auto species = file.get<std::uint32_t>(0, "particles/typeid");
  const auto diameter = file.get<float>(0, "particles/diameter"), mass = file.get<float>(0, "particles/mass");
  ASSERT_EQ(species.size(), 60U);
  for (std::size_t i = 0; i < 60; ++i) {
    const double a = i < small ? 1 : 1.4;
    EXPECT_EQ(species[i], i < small ? 0U : 1U);
    EXPECT_EQ(diameter[i], static_cast<float>(2 * a));
    EXPECT_FLOAT_EQ(mass[i], static_cast<float>(4.0 / 3.0 * M_PI * 0.1 * a * a * a));
  }
  const auto names = file.get<std::int8_t>(0, "particles/types");
  EXPECT_EQ(std::string(names.begin(), names.end()), std::string("A\0\0\0B\0\0\0", 8));
  EXPECT_EQ(file.get<std::uint32_t>(1, "particles/N"), std::vector<std::uint32_t>{60});
  EXPECT_FALSE(file.has(1, "particles/typeid")) << "the first frame is the default of all";
}

// F_n = k_n delta, and gap = -2 delta / (a_i + a_j) from the positions; Coulomb's law bounds the other force.
TEST(Trajectory, ListsContactsWithTheirForces) {
  Simulation simulation = started(scene_with_trajectory());
  simulation.advance(equilibration + production);
  const GsdReader file = file_of(simulation);
  const double stiffness = 1e4, friction = 0.5;
  std::map<int, int> states;
  for (std::uint64_t k = 0; k < production; ++k) {
    const auto group = file.get<std::uint32_t>(k, "bonds/group"),
               number = file.get<std::uint32_t>(k, "log/particles/contact_number");
    const auto gap = file.get<float>(k, "log/bonds/gap"),
               normal = file.get<float>(k, "log/bonds/normal_force"),
               tangential = file.get<float>(k, "log/bonds/tangential_force"),
               diameter = file.get<float>(0, "particles/diameter"),
               position = file.get<float>(k, "particles/position"),
               box = file.get<float>(k, "configuration/box");
    const auto state = file.get<std::uint8_t>(k, "log/bonds/state");
    ASSERT_EQ(file.get<std::uint32_t>(k, "bonds/N"),
              std::vector<std::uint32_t>{static_cast<std::uint32_t>(gap.size())});
    std::vector<std::uint32_t> counted(60);
    for (std::size_t b = 0; b < gap.size(); ++b) {
      const std::size_t i = group[2 * b], j = group[2 * b + 1];
      ++counted[i];
      ++counted[j];
      EXPECT_LT(i, j);
      const double sum = 0.5 * (diameter[i] + diameter[j]);
      // The nearest image: the box is wider than four diameters.
      double r[3];
      for (std::size_t c = 0; c < 3; ++c) r[c] = position[3 * j + c] - position[3 * i + c];
      const double up = std::round(r[1] / box[1]);
      r[1] -= up * box[1];
      r[0] -= up * box[1] * box[3];
      r[0] -= box[0] * std::round(r[0] / box[0]);
      r[2] -= box[2] * std::round(r[2] / box[2]);
      const double overlap = sum - std::hypot(r[0], r[1], r[2]);
      EXPECT_NEAR(gap[b], -2 * overlap / sum, 1e-5);
      EXPECT_LT(gap[b], 0);
      EXPECT_NEAR(normal[b], stiffness * -0.5 * gap[b] * sum, 1e-6 * normal[b]);
      EXPECT_LE(tangential[b], friction * normal[b] * (1 + 1e-2));
      EXPECT_EQ(state[b], tangential[b] > 0.99F * friction * normal[b] ? 2 : 1);
      ++states[state[b]];
    }
    EXPECT_EQ(counted, number);
  }
  EXPECT_GT(states[1], 100);
  EXPECT_GT(states[2], 100);
}

TEST(Trajectory, HasTheSameBytesOnAnyNumberOfThreads) {
  Json document = scene_with_trajectory({{"particles", {{"count", 5000}}}}, {{"time", 0.02}});
  document["duration"] = {{"equilibration", {{"time", 0.02}}}, {"production", {{"time", 0.08}}}};
  for (const Json& patch : {Json::object(), implicit_and_light}) {
    document.merge_patch(patch);
    Simulation one = started(document, 1), two = started(document, 2);
    ASSERT_TRUE(one.advance(1000) && two.advance(1000));
    EXPECT_EQ(one.frames()->count(), 4U);
    EXPECT_TRUE(one.frames()->pending() == two.frames()->pending());
    EXPECT_TRUE(one.frames()->tail() == two.frames()->tail());
  }
}

// The rate is 2 and the Brownian time eta a^3 / kT is 5.
TEST(Trajectory, HasAnIntervalInStrainTimeOrBrownianTimes) {
  const auto steps = [](const Json& limits) {
    const Scene scene = read_scene(scene_with_trajectory(Json::object(), limits), "scene.json");
    return make_observables(scene, {0.001, 1000, {8, 8, 8}}, "scene.json").front()->interval();
  };
  EXPECT_EQ(steps({{"time", 0.01}}), 10u);
  EXPECT_EQ(steps({{"strain", 0.1}}), 50u);
  EXPECT_EQ(steps({{"brownian_times", 0.01}}), 50u);
  EXPECT_EQ(steps({{"strain", 0.1}, {"time", 0.01}}), 10u) << "the first that is reached";
  EXPECT_THROW(steps(Json::object()), InputError);
}

TEST(Trajectory, IsRefusedWhereNobodyCouldKeepIt) {
  const Scene scene = read_scene(scene_with_trajectory(), "scene.json");
  const auto make = [](const Scene& of, std::uint64_t steps) {
    make_observables(of, {0.002, steps, {8, 8, 8}}, "scene.json");
  };
  EXPECT_NO_THROW(make(scene, 50'000));
  EXPECT_THROW(make(scene, 50'001), InputError);
  // 10^6 spheres of 76 bytes with 6 contacts of 21 bytes each: 21 frames fit into 4 GiB.
  Scene large = scene;
  large.particles.count = 1'000'000;
  EXPECT_NO_THROW(make(large, 21));
  EXPECT_THROW(make(large, 22), InputError);
  EXPECT_THROW(read_scene(scene_with_trajectory({{"contact", nullptr}}), "scene.json"), InputError);
}

}  // namespace
}  // namespace peclet::engine
