// Realisations that start from the spheres of a file.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "contract/durable_file.h"
#include "contract/errors.h"
#include "contract/sha256.h"
#include "engine/observables/scene_reading.h"
#include "engine/realisation/growing_file.h"
#include "engine/realisation/job.h"
#include "engine/realisation/packing.h"
#include "engine/realisation/placed_spheres.h"
#include "engine/snapshots/gsd_file.h"
#include "tests/engine/small_scene.h"
#include "tests/engine/temporary_folder.h"

namespace peclet::engine {
namespace {

namespace fs = std::filesystem;

JobSpecification job_of(const Json& scene, const std::string& files, std::uint64_t seed = 2) {
  JobSpecification job;
  job.header = {"point", seed};
  job.scene = scene;
  job.scene_name = "scene.json";
  job.files = files;
  return job;
}

class StartedJob : public testing::Test {
 protected:
  StartedJob() {
    const Json scene = small_scene({{"files", {{"final_configuration", true}}},
                                    {"observables", {"trajectory"}},
                                    {"trajectory", {{"interval", {{"time", 0.1}}}}}});
    run_job(job_of(scene, (folder_ / "a.").string()), {});
  }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  Json start(const std::string& name, const char* key = "file") const {
    return {{key, path(name)}, {"sha256", sha256_of_file(path(name))}};
  }
  static Json scene(const Json& start, const Json& patch = Json::object()) {
    Json all = small_scene(patch);
    all["start"] = start;
    return all;
  }
  static std::string refusal(const Json& scene, std::uint64_t seed = 0) {
    try {
      placed_spheres(read_scene(scene, "scene.json"), seed, "scene.json");
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  TemporaryFolder folder_;
};

// Compares the end of a realisation, by its own time loop, with the start of the next.
TEST_F(StartedJob, BeginsWhereTheOtherOneHasEnded) {
  const Scene of_first = read_scene(small_scene(), "");
  Simulation first(of_first, make_schedule(of_first, ""), 2, 1, "");
  first.start();
  while (!first.advance(1000)) {
  }
  const Scene of_next = read_scene(scene(start("a.final.xyz")), "");
  const PlacedSpheres placed = placed_spheres(of_next, 9, "");
  EXPECT_TRUE(placed.in_motion);
  EXPECT_TRUE(placed.system.box.edges() == first.system().box.edges());
  EXPECT_NE(placed.system.box.tilt(), 0);
  EXPECT_EQ(placed.system.box.strain(), 0) << "counts from here";
  const ParticleState &was = first.system().particles, &is = placed.system.particles;
  for (std::size_t k = 0; k < was.count(); ++k) {
    const std::uint32_t i = was.id[k];
    EXPECT_TRUE(is.position[i] == was.position[k] && is.velocity[i] == was.velocity[k]);
    EXPECT_TRUE(is.angular_velocity[i] == was.angular_velocity[k]);
    EXPECT_EQ(is.radius[i], was.radius[k]);
    EXPECT_EQ(is.mass[i], was.mass[k]);
  }
}

TEST_F(StartedJob, OfATrajectoryBeginsAtItsFrame) {
  Json start_ = start("a.trajectory.gsd");
  const PlacedSpheres last = placed_spheres(read_scene(scene(start_), ""), 0, "");
  start_["frame"] = 0;
  const PlacedSpheres first = placed_spheres(read_scene(scene(start_), ""), 0, "");
  EXPECT_GT(norm(last.system.particles.position[0] - first.system.particles.position[0]), 0.01);
  EXPECT_TRUE(first.in_motion);
  start_["frame"] = 7;
  EXPECT_NE(refusal(scene(start_)).find("frame 7: must be from 0 to 6"), std::string::npos)
      << refusal(scene(start_));
}

// The initial cell is not a cube; a checkpoint has to store it.
TEST_F(StartedJob, ThatIsCutAndResumedEndsAsOneThatWasNot) {
  for (const char* method : {"explicit", "implicit"}) {
    const Json scene_ = scene(start("a.final.xyz"),
                              {{"integrator", {{"method", method}}},
                               {"particles", {{"density", method == std::string("implicit") ? 0.01 : 0.1}}},
                               {"duration", {{"production", {{"time", 4}}}}}});
    JobSpecification job = job_of(scene_, "");
    Json uncut = run_job(job, {}).value();
    EXPECT_EQ(uncut.at("ending").at("cause"), "completed");
    job.checkpoint = folder_ / "checkpoint";
    std::optional<Json> result;
    int drains = 0;
    JobEvents events;
    events.drain_requested = [] { return true; };
    for (; !result; ++drains) result = run_job(job, events);
    EXPECT_GE(drains, 2);
    fs::remove(job.checkpoint);
    uncut.erase("cost");
    result->erase("cost");
    EXPECT_EQ(result->dump(), uncut.dump());
  }
}

TEST_F(StartedJob, OfAListTakesTheLineOfItsSeed) {
  const std::string line = fmt::format("{}  {}\n", sha256_of_file(path("a.final.xyz")), path("a.final.xyz"));
  const std::string other =
      fmt::format("{} *{}\n", sha256_of_file(path("a.trajectory.gsd")), path("a.trajectory.gsd"));
  write_durably(path("starts.sha256"), line + other + line.substr(1) + "x  y\n");
  const Json start_ = start("starts.sha256", "list");
  const auto place = [&](std::uint64_t seed) {
    return placed_spheres(read_scene(scene(start_), ""), seed, "").system.particles.position[0];
  };
  EXPECT_FALSE(place(0) == place(1)) << "the trajectory has single numbers";
  EXPECT_LT(norm(place(0) - place(1)), 40);
  for (const std::uint64_t seed : {std::uint64_t{2}, std::uint64_t{3}}) {
    EXPECT_NE(refusal(scene(start_), seed).find("/start/list"), std::string::npos);
    EXPECT_NE(refusal(scene(start_), seed).find("must be lines of sha256sum"), std::string::npos);
  }
  EXPECT_NE(refusal(scene(start_), 4).find("must have a line for seed 4, the 5th"), std::string::npos);
  write_durably(path("a.final.xyz"), read_file(path("a.final.xyz")) + "\n");
  EXPECT_NE(refusal(scene(start_), 0).find("must be that of " + path("a.final.xyz")), std::string::npos);
  write_durably(path("starts.sha256"), line);
  EXPECT_NE(refusal(scene(start_), 0).find("/start/sha256"), std::string::npos);
}

TEST_F(StartedJob, ThatDoesNotFitItsFileIsRefused) {
  const Json start_ = start("a.final.xyz");
  const auto expect = [&](const Json& scene_, const std::string& reason) {
    EXPECT_NE(refusal(scene_).find(reason), std::string::npos) << refusal(scene_) << " has not " << reason;
  };
  EXPECT_EQ(refusal(scene(start_)), "");
  expect(scene(start_, {{"volume_fraction", 0.44}}), "/volume_fraction: 0.44: makes a box of");
  expect(scene(start_, {{"particles", {{"count", 59}}}}), "/particles/count: 59: must be 60");
  Json others = scene(start_);
  others["particles"]["species"][0]["number_share"] = 1;
  others["particles"]["species"][1]["number_share"] = 1;
  for (Json& species : others["particles"]["species"]) species.erase("volume_share");
  others["volume_fraction"] = 0.45;
  EXPECT_NE(refusal(others), "");
  Json changed = start_;
  changed["sha256"] = std::string(64, 'a');
  expect(scene(changed), "/start/sha256: " + std::string(64, 'a').substr(0, 20));
  changed["sha256"] = "ABC";
  expect(scene(changed), "/start/sha256: \"ABC\": must be a SHA-256");
  changed = start_;
  changed["file"] = "a.final.xyz";
  expect(scene(changed), "/start/file: \"a.final.xyz\": must be an absolute path");
  changed["file"] = path("absent");
  expect(scene(changed), "must be a file that is there");
  changed["list"] = path("absent");
  expect(scene(changed), "/start");
  changed = start_;
  changed["file"] = "/" + std::string(5000, 'x');
  expect(scene(changed), "must be a file that is there");
  write_durably(path("no.xyz"), "no file of spheres\n");
  expect(scene(start("no.xyz")), path("no.xyz"));
}

// A list saved by other programs: with a byte-order mark, Windows line ends, and empty lines at the end.
TEST_F(StartedJob, OfAListInAnotherDialectIsTheSame) {
  const std::string line = fmt::format("{}  {}", sha256_of_file(path("a.final.xyz")), path("a.final.xyz"));
  write_durably(path("plain"), line + "\n" + line + "\n");
  write_durably(path("dialect"), "\xef\xbb\xbf" + line + "\r\n" + line + "\r\n\r\n");
  const Json dialect = start("dialect", "list");
  const auto place = [&](const Json& start_, std::uint64_t seed) {
    return placed_spheres(read_scene(scene(start_), ""), seed, "").system.particles.position[7];
  };
  for (const std::uint64_t seed : {std::uint64_t{0}, std::uint64_t{1}}) {
    EXPECT_TRUE(place(dialect, seed) == place(start("plain", "list"), seed));
  }
  EXPECT_NE(refusal(scene(dialect), 2).find("must have a line for seed 2,"), std::string::npos)
      << refusal(scene(dialect), 2);
}

// The cell edge has six digits, as in LF_DEM: up to 5e-6 of it may be lost.
TEST_F(StartedJob, OfAFileWithSixDigitsIsTaken) {
  const double edge =
      placed_spheres(read_scene(scene(start("a.final.xyz")), ""), 0, "").system.box.lengths().x;
  const auto with_edge = [&](double length) {
    std::string text =
        fmt::format("60\nLattice=\"{0} 0 0 0 {0} 0 0 0 {0}\" Properties=pos:R:3:radius:R:1\n", length);
    for (const double a : species_radii(read_scene(small_scene(), "").particles)) {
      text += fmt::format("1 2 3 {:.6g}\n", a);
    }
    write_durably(path("six.xyz"), text);
    return refusal(scene(start("six.xyz")));
  };
  EXPECT_EQ(with_edge(edge * (1 + 4.9e-6)), "");
  // The volume fraction is phi (L / L')^3.
  const double other = 1.01 * edge, fraction = 0.45 / std::pow(1.01, 3);
  EXPECT_NE(with_edge(other).find(fmt::format("in that cell the volume fraction is {:.8g}", fraction)),
            std::string::npos)
      << with_edge(other);
  EXPECT_NE(with_edge(edge * (1 + 5.1e-6)).find("must be as long within 5e-06"), std::string::npos);
}

TEST_F(StartedJob, OfSpheresInAnotherOrderNamesTheOrder) {
  std::vector<double> radius = species_radii(read_scene(small_scene(), "").particles);
  std::ranges::reverse(radius);
  const double edge =
      placed_spheres(read_scene(scene(start("a.final.xyz")), ""), 0, "").system.box.lengths().x;
  std::string text =
      fmt::format("60\nLattice=\"{0} 0 0 0 {0} 0 0 0 {0}\" Properties=pos:R:3:radius:R:1\n", edge);
  for (const double a : radius) text += fmt::format("1 2 3 {}\n", a);
  write_durably(path("order.xyz"), text);
  EXPECT_NE(refusal(scene(start("order.xyz")))
                .find("where its radius is 1.4: the start has the same radii in another order"),
            std::string::npos)
      << refusal(scene(start("order.xyz")));
}

TEST_F(StartedJob, OfAGsdFileWithoutDiametersSaysSo) {
  gsd::Frames frames;
  frames.add("configuration/box", std::vector<float>{10, 10, 10, 0, 0, 0});
  frames.add_single<std::uint32_t>("particles/N", 60);
  frames.add("particles/position", std::vector<float>(180), 3);
  frames.end_frame();
  write_durably(path("bare.gsd"), frames.head() + frames.pending() + frames.tail());
  EXPECT_NE(refusal(scene(start("bare.gsd"))).find("must have particles/diameter, which is absent"),
            std::string::npos)
      << refusal(scene(start("bare.gsd")));
}

TEST_F(StartedJob, OfOneFileIsNoCampaignWithoutNoise) {
  const Json patch = {{"fluid", {{"thermal_energy", nullptr}}}};
  const auto check = [&](const Json& document) {
    check_start_of_campaign(read_scene(document, ""), "scene");
  };
  EXPECT_NO_THROW(check(scene(start("a.final.xyz"))));
  EXPECT_THROW(check(scene(start("a.final.xyz"), patch)), InputError);
  write_durably(path("starts"),
                fmt::format("{}  {}\n", sha256_of_file(path("a.final.xyz")), path("a.final.xyz")));
  EXPECT_NO_THROW(check(scene(start("starts", "list"), patch)));
}

TEST_F(StartedJob, OfAListNeedsALineForEverySeedOfTheCampaign) {
  const std::string line = fmt::format("{}  {}\n", sha256_of_file(path("a.final.xyz")), path("a.final.xyz"));
  write_durably(path("starts"), line + line + line);
  const Scene listed = read_scene(scene(start("starts", "list")), "");
  EXPECT_NO_THROW(check_start_of_campaign(listed, "scene", 3));
  try {
    check_start_of_campaign(listed, "scene", 4);
    FAIL() << "taken";
  } catch (const InputError& error) {
    EXPECT_EQ(error.pointer(), "/start/list");
    EXPECT_NE(std::string(error.what()).find("for each of the 4 seeds"), std::string::npos) << error.what();
  }
}

TEST_F(StartedJob, OfANameThatNoFileCanHaveIsRefused) {
  for (const char* const key : {"file", "list"}) {
    Json named = {{"sha256", std::string(64, 'a')}, {key, "/" + std::string(5000, 'a')}};
    EXPECT_THROW(check_start_of_campaign(read_scene(scene(named), ""), "scene"), InputError) << key;
  }
}

// Seeds 0 and 2 have one file under two names.
TEST_F(StartedJob, OfAListThatHasOneFileTwiceIsNoCampaignWithoutNoise) {
  const Json patch = {{"fluid", {{"thermal_energy", nullptr}}}};
  const auto refusal_of = [&](const Json& document) -> std::string {
    try {
      check_start_of_campaign(read_scene(document, ""), "scene.json");
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  fs::copy_file(path("a.final.xyz"), path("b.xyz"));
  const auto line = [&](const std::string& name) {
    return fmt::format("{}  {}\n", sha256_of_file(path(name)), path(name));
  };
  write_durably(path("starts"), line("a.final.xyz") + line("a.trajectory.gsd") + line("b.xyz"));
  const std::string message = refusal_of(scene(start("starts", "list"), patch));
  EXPECT_NE(message.find("scene.json: /start/list"), std::string::npos) << message;
  EXPECT_NE(message.find("seed 2 begins at a file of the same hash as seed 0"), std::string::npos) << message;
  EXPECT_EQ(refusal_of(scene(start("starts", "list"))), "") << "with noise";
  write_durably(path("starts"), line("a.final.xyz") + line("a.trajectory.gsd"));
  EXPECT_EQ(refusal_of(scene(start("starts", "list"), patch)), "");
}

// With positions alone velocities are those of the flow plus noise by the seed, as after packing.
TEST_F(StartedJob, WithoutMotionInItsFileBeginsWithThatOfAFreshOne) {
  std::string text = read_file(path("a.final.xyz"));
  const std::string known = "angular_velocity:R:3";
  text.replace(text.find(known), known.size(), "something_else:R:3");
  write_durably(path("still.xyz"), text);
  const Scene scene_ = read_scene(scene(start("still.xyz"), {{"fluid", {{"thermal_energy", nullptr}}}}), "");
  const PlacedSpheres placed = placed_spheres(scene_, 0, "");
  EXPECT_FALSE(placed.in_motion);
  Simulation simulation(scene_, make_schedule(scene_, ""), 0, 1, "");
  simulation.start(placed.system, placed.in_motion);
  const ParticleState& particles = simulation.system().particles;
  for (std::size_t i = 0; i < particles.count(); ++i) {
    EXPECT_NEAR(particles.velocity[i].x, 2 * particles.position[i].y, 1e-12);
    EXPECT_EQ(particles.angular_velocity[i].z, -1);
  }
}

}  // namespace
}  // namespace peclet::engine
