// The final configuration as other programs read it, compared with the state and with a whole realisation.
#include <gtest/gtest.h>

#include <array>
#include <sstream>

#include "contract/durable_file.h"
#include "contract/sha256.h"
#include "engine/pictures/picture.h"
#include "engine/realisation/growing_file.h"
#include "engine/snapshots/snapshot.h"
#include "tests/engine/realisation/small_result.h"
#include "tests/engine/temporary_folder.h"

namespace peclet::engine {
namespace {

struct Sphere {
  std::uint32_t id;
  Vector3 position, velocity, spin;
  double radius;
};
struct Text {
  std::array<double, 9> lattice{};
  double time = 0, strain = 0;
  std::vector<Sphere> spheres;
};

double number_after(const std::string& line, const std::string& key) {
  return std::stod(line.substr(line.find(key) + key.size()));
}

// A reader written from the format alone.
Text read_extended_xyz(const std::string& bytes) {
  std::istringstream lines(bytes);
  std::string line;
  Text text;
  std::getline(lines, line);
  const std::size_t count = std::stoul(line);
  std::getline(lines, line);
  EXPECT_TRUE(contains(line, " Properties=id:I:1:pos:R:3:radius:R:1:velo:R:3:angular_velocity:R:3 "));
  std::istringstream lattice(line.substr(line.find("Lattice=\"") + 9));
  for (double& component : text.lattice) lattice >> component;
  text.time = number_after(line, "Time=");
  text.strain = number_after(line, "Strain=");
  while (std::getline(lines, line)) {
    std::istringstream row(line);
    Sphere sphere{};
    row >> sphere.id >> sphere.position.x >> sphere.position.y >> sphere.position.z >> sphere.radius >>
        sphere.velocity.x >> sphere.velocity.y >> sphere.velocity.z >> sphere.spin.x >> sphere.spin.y >>
        sphere.spin.z;
    EXPECT_FALSE(row.fail()) << line;
    text.spheres.push_back(sphere);
  }
  EXPECT_EQ(text.spheres.size(), count);
  return text;
}

// Numbers set by hand with many digits, compared bit by bit.
TEST(FinalConfiguration, IsReadBackAsItWas) {
  System system;
  system.particles = make_particles({1.4, 1, 1.0 / 3}, 0.1);
  system.particles.id = {2, 0, 1};
  system.particles.position.set(0, {0.1, 1.0 / 7, -2.5e-17});
  system.particles.position.set(1, {12.345678901234567, 0, 1e22});
  system.particles.position.set(2, {-0.7, 3, 4});
  system.particles.velocity.set(0, {1e-300, -1, 2.0 / 3});
  system.particles.angular_velocity.set(0, {0.1, 1.0 / 9, -7});
  system.box = PeriodicCell({10, 10.5, 11}, Matrix3{});
  Matrix3 gradient{};
  gradient.column[1].x = 0.3;
  system.box.deform(gradient);
  system.clock = {0, 0.002, 150};
  const Text text = read_extended_xyz(extended_xyz(system));
  // A2 = (strain Ly, Ly, 0).
  const std::array<double, 9> lattice{10, 0, 0, 0.3 * 10.5, 10.5, 0, 0, 0, 11};
  EXPECT_EQ(text.lattice, lattice);
  EXPECT_EQ(text.time, 150 * 0.002);
  EXPECT_EQ(text.strain, 0.3);
  ASSERT_EQ(text.spheres.size(), 3U);
  const std::array<std::size_t, 3> place{1, 2, 0};  // by id
  for (std::size_t i = 0; i < 3; ++i) {
    const Sphere& sphere = text.spheres[i];
    EXPECT_EQ(sphere.id, i);
    EXPECT_EQ(sphere.radius, system.particles.radius[place[i]]);
    EXPECT_TRUE(sphere.position == system.particles.position[place[i]]);
    EXPECT_TRUE(sphere.velocity == system.particles.velocity[place[i]]);
    EXPECT_TRUE(sphere.spin == system.particles.angular_velocity[place[i]]);
  }
}

const Json with_final_configuration = {{"files", {{"final_configuration", true}}}};

TEST(FinalConfiguration, OfARealisationIsThatOfTheSameTimeLoop) {
  const Json scene = small_scene(with_final_configuration);
  const TemporaryFolder folder;
  const Json result = run_job(job_of(scene, (folder / "job@").string()), {}).value();
  const std::string bytes = read_file(folder / "job@final.xyz");
  const Json listed = {{{"name", "final.xyz"}, {"bytes", bytes.size()}, {"sha256", sha256(bytes)}}};
  EXPECT_EQ(result.at("files"), listed);

  Simulation simulation = started(scene_from(), 2);
  while (!simulation.advance(1000)) {
  }
  const ParticleState& particles = simulation.system().particles;
  const Text text = read_extended_xyz(bytes);
  ASSERT_EQ(text.spheres.size(), particles.count());
  for (std::size_t i = 0; i < particles.count(); ++i) {
    const Sphere& sphere = text.spheres.at(particles.id[i]);
    EXPECT_EQ(sphere.id, particles.id[i]);
    EXPECT_EQ(sphere.radius, particles.radius[i]);
    EXPECT_EQ(sphere.position.x, particles.position[i].x);
    EXPECT_EQ(sphere.velocity.y, particles.velocity[i].y);
  }
  // Rate 2 over 420 steps of 0.002.
  EXPECT_NEAR(text.strain, 1.68, 1e-12);
  EXPECT_NEAR(text.time, 0.84, 1e-12);
}

// A turned cell and its strain: L = e (x, -y, 0), and the Hencky strain e t.
TEST(FinalConfiguration, OfAnExtensionIsReadBack) {
  const Json scene = small_scene(
      together({with_final_configuration, {{"flow", {{"shear_rate", nullptr}, {"extension_rate", 1}}}}}));
  const TemporaryFolder folder;
  run_job(job_of(scene, (folder / "job@").string()), {}).value();
  const SnapshotFile file(folder / "job@final.xyz");
  const Snapshot snapshot = file.read(0);
  EXPECT_EQ(snapshot.count(), read_scene(small_scene(), "").particles.count);
  EXPECT_NEAR(*snapshot.strain, 0.84, 1e-12);
  EXPECT_NEAR(*snapshot.time, 0.84, 1e-12);
  EXPECT_TRUE(*snapshot.velocity_gradient == (Matrix3{Vector3{1, 0, 0}, Vector3{0, -1, 0}, Vector3{}}));
  EXPECT_NE(snapshot.lattice.column[0].y, 0);
  EXPECT_FALSE(picture_of(snapshot, {.file = "", .output = "", .size = "64x64"}).rgb.empty());
}

TEST(FinalConfiguration, IsLeftOnlyWhereItIsAskedFor) {
  const TemporaryFolder folder;
  for (const Json& patch : {Json::object(), Json{{"files", {{"final_configuration", false}}}}}) {
    const Json result = run_job(job_of(small_scene(patch), (folder / "job@").string()), {}).value();
    EXPECT_FALSE(result.contains("files"));
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  EXPECT_FALSE(read_scene(small_scene(), "").document.contains("files")) << "it is part of the scene's hash";
}

TEST(FinalConfiguration, IsRefusedWhereNobodyTakesIt) {
  EXPECT_THROW(run_job(job_of(small_scene(with_final_configuration)), {}), InputError);
}

}  // namespace
}  // namespace peclet::engine
