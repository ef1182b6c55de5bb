// Realisations that start from the spheres of a file.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "contract/durable_file.h"
#include "contract/sha256.h"
#include "engine/realisation/packing.h"
#include "engine/realisation/placed_spheres.h"
#include "engine/realisation/start_block.h"
#include "engine/snapshots/gsd_file.h"
#include "tests/engine/realisation/small_result.h"
#include "tests/engine/temporary_folder.h"

namespace peclet::engine {
namespace {

namespace fs = std::filesystem;

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
  // Returns the line of sha256sum for a file.
  std::string line(const std::string& name) const {
    return fmt::format("{}  {}\n", sha256_of_file(path(name)), path(name));
  }
  static PlacedSpheres placed(const Json& start, std::uint64_t of_seed = 0) {
    return placed_spheres(read_scene(scene(start), ""), of_seed, "");
  }
  static std::string refusal(const Json& scene, std::uint64_t of_seed = 0) {
    return refusal_by([&] { placed_spheres(read_scene(scene, "scene.json"), of_seed, "scene.json"); });
  }
  static std::string refusal_of_campaign(const Json& document) {
    return refusal_by([&] { check_start_of_campaign(read_scene(document, ""), "scene.json"); });
  }
  double edge() const { return placed(start("a.final.xyz")).system.box.lengths().x; }
  // Returns the refusal of a file of spheres at one place in a cube.
  std::string refusal_of_spheres(double edge, const std::vector<double>& radius) const {
    std::string text =
        fmt::format("60\nLattice=\"{0} 0 0 0 {0} 0 0 0 {0}\" Properties=pos:R:3:radius:R:1\n", edge);
    for (const double a : radius) text += fmt::format("1 2 3 {:.6g}\n", a);
    write_durably(path("spheres.xyz"), text);
    return refusal(scene(start("spheres.xyz")));
  }

  TemporaryFolder folder_;
};

// Two spheres of radius 1 whose centres are 1.7 apart, across the boundary of a cell of edge 10.
TEST_F(StartedJob, WithSpheresThatOverlapTooMuchIsNoCampaign) {
  ParticleState two = make_particles({1, 1}, 1);
  two.position.set(0, {0.8, 5, 5});
  two.position.set(1, {9.1, 5, 5});
  EXPECT_NEAR(largest_overlap(two, PeriodicCell({10, 10, 10}, {})), 0.3, 1e-12);
  two.position.set(1, {8.7, 5, 5});
  EXPECT_EQ(largest_overlap(two, PeriodicCell({10, 10, 10}, {})), 0);

  // Sphere 1 is moved to where sphere 0 is.
  std::string text = read_file(path("a.final.xyz"));
  const auto line = [&](std::size_t k) {
    std::size_t begin = 0;
    for (std::size_t i = 0; i < k; ++i) begin = text.find('\n', begin) + 1;
    return std::pair(begin, text.find('\n', begin) - begin);
  };
  const auto [first, length] = line(2);
  const auto [second, length_of_second] = line(3);
  const std::string of_first = text.substr(first, length), of_second = text.substr(second, length_of_second);
  const std::string id = of_second.substr(0, of_second.find(' '));
  text.replace(second, length_of_second, id + of_first.substr(of_first.find(' ')));
  write_durably(path("doubled.xyz"), text);
  EXPECT_TRUE(contains(refusal_of_campaign(scene(start("doubled.xyz"))),
                       "must have spheres that overlap by at most 0.2 radii"));
}

// The keys that are written for a file make a scene that begins with it.
TEST_F(StartedJob, HasAScenesKeysFromTheVerbStart) {
  const auto scene_of_block = [&](const WrittenKeys& answer) {
    const Json block = Json::parse("{" + answer.block + "}");
    Json all = small_scene();
    all.update(block);
    all["particles"]["density"] = small_scene()["particles"]["density"];
    return all;
  };
  for (const char* const name : {"a.final.xyz", "a.trajectory.gsd"}) {
    const WrittenKeys answer = start_block({.files = {path(name)}, .list = "", .frame = 0});
    EXPECT_EQ(refusal(scene_of_block(answer)), "") << answer.block;
    EXPECT_TRUE(contains(answer.remarks, "60 spheres of 2 radii")) << answer.remarks;
  }
  const std::vector<std::string> files = {path("a.final.xyz"), path("a.trajectory.gsd")};
  EXPECT_TRUE(contains(refusal_by([&] { start_block({.files = files, .list = ""}); }), "--list: is missing"));
  EXPECT_TRUE(
      contains(refusal_by([&] { start_block({.files = files, .list = files[1]}); }), "would be lost"));
  const WrittenKeys several = start_block({.files = files, .list = path("starts")});
  EXPECT_EQ(read_file(path("starts")), line("a.final.xyz") + line("a.trajectory.gsd"));
  EXPECT_EQ(refusal(scene_of_block(several), 1), "") << several.block;
}

// Compares the end of a realisation, by its own time loop, with the start of the next.
TEST_F(StartedJob, BeginsWhereTheOtherOneHasEnded) {
  Simulation first = started(scene_from(), 2);
  while (!first.advance(1000)) {
  }
  const PlacedSpheres placed = this->placed(start("a.final.xyz"), 9);
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
  const PlacedSpheres last = placed(start_);
  start_["frame"] = 0;
  const PlacedSpheres first = placed(start_);
  EXPECT_GT(norm(last.system.particles.position[0] - first.system.particles.position[0]), 0.01);
  EXPECT_TRUE(first.in_motion);
  start_["frame"] = 7;
  EXPECT_TRUE(contains(refusal(scene(start_)), "frame 7: must be from 0 to 6"));
}

// The initial cell is not a cube; a checkpoint has to store it.
TEST_F(StartedJob, ThatIsCutAndResumedEndsAsOneThatWasNot) {
  for (const char* method : {"explicit", "implicit"}) {
    const Json scene_ = scene(start("a.final.xyz"),
                              {{"integrator", {{"method", method}}},
                               {"particles", {{"density", method == std::string("implicit") ? 0.01 : 0.1}}},
                               {"duration", {{"production", {{"time", 4}}}}}});
    JobSpecification job = job_of(scene_);
    const Json uncut = run_job(job, {}).value();
    EXPECT_EQ(uncut.at("ending").at("cause"), "completed");
    job.checkpoint = folder_ / "checkpoint";
    std::optional<Json> result;
    int drains = 0;
    JobEvents events;
    events.drain_requested = [] { return true; };
    for (; !result; ++drains) result = run_job(job, events);
    EXPECT_GE(drains, 2);
    fs::remove(job.checkpoint);
    EXPECT_EQ(without_cost(*result).dump(), without_cost(uncut).dump());
  }
}

TEST_F(StartedJob, OfAListTakesTheLineOfItsSeed) {
  const std::string line = this->line("a.final.xyz");
  const std::string other =
      fmt::format("{} *{}\n", sha256_of_file(path("a.trajectory.gsd")), path("a.trajectory.gsd"));
  write_durably(path("starts.sha256"), line + other + line.substr(1) + "x  y\n");
  const Json start_ = start("starts.sha256", "list");
  const auto place = [&](std::uint64_t of_seed) {
    return placed(start_, of_seed).system.particles.position[0];
  };
  EXPECT_FALSE(place(0) == place(1)) << "the trajectory has single numbers";
  EXPECT_LT(norm(place(0) - place(1)), 40);
  for (const std::uint64_t of_seed : {2U, 3U}) {
    EXPECT_TRUE(contains(refusal(scene(start_), of_seed), "/start/list"));
    EXPECT_TRUE(contains(refusal(scene(start_), of_seed), "must be lines of sha256sum"));
  }
  EXPECT_TRUE(contains(refusal(scene(start_), 4), "must have a line for seed 4, line 5"));
  write_durably(path("a.final.xyz"), read_file(path("a.final.xyz")) + "\n");
  EXPECT_TRUE(contains(refusal(scene(start_), 0), "must be that of " + path("a.final.xyz")));
  write_durably(path("starts.sha256"), line);
  EXPECT_TRUE(contains(refusal(scene(start_), 0), "/start/sha256"));
}

TEST_F(StartedJob, ThatDoesNotFitItsFileIsRefused) {
  const Json start_ = start("a.final.xyz");
  const auto expect = [&](const Json& scene_, const std::string& reason) {
    EXPECT_TRUE(contains(refusal(scene_), reason));
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
  const std::string text = this->line("a.final.xyz"), line = text.substr(0, text.size() - 1);
  write_durably(path("plain"), line + "\n" + line + "\n");
  write_durably(path("dialect"), "\xef\xbb\xbf" + line + "\r\n" + line + "\r\n\r\n");
  const Json dialect = start("dialect", "list");
  const auto place = [&](const Json& start_, std::uint64_t of_seed) {
    return placed(start_, of_seed).system.particles.position[7];
  };
  for (const std::uint64_t of_seed : {0U, 1U}) {
    EXPECT_TRUE(place(dialect, of_seed) == place(start("plain", "list"), of_seed));
  }
  EXPECT_TRUE(contains(refusal(scene(dialect), 2), "must have a line for seed 2,"));
}

// The cell edge has six digits, as in LF_DEM: up to 5e-6 of it may be lost.
TEST_F(StartedJob, OfAFileWithSixDigitsIsTaken) {
  const double edge = this->edge();
  const auto with_edge = [&](double length) {
    return refusal_of_spheres(length, species_radii(read_scene(small_scene(), "").particles));
  };
  EXPECT_EQ(with_edge(edge * (1 + 4.9e-6)), "");
  // The volume fraction is phi (L / L')^3.
  const double other = 1.01 * edge, fraction = 0.45 / std::pow(1.01, 3);
  EXPECT_TRUE(
      contains(with_edge(other), fmt::format("in that cell the volume fraction is {:.8g}", fraction)));
  EXPECT_TRUE(contains(with_edge(edge * (1 + 5.1e-6)), "must be as long within 5e-06"));
}

// Every sphere keeps its place and its radius; those of one radius keep their order.
TEST_F(StartedJob, OfSpheresInAnotherOrderHasThemSpeciesBySpecies) {
  std::vector<double> radius = species_radii(read_scene(small_scene(), "").particles);
  const std::vector<double> of_scene = radius;
  std::ranges::reverse(radius);
  const double edge = this->edge();
  std::string text =
      fmt::format("60\nLattice=\"{0} 0 0 0 {0} 0 0 0 {0}\" Properties=pos:R:3:radius:R:1\n", edge);
  std::map<double, std::vector<double>> places;
  for (std::size_t i = 0; i < radius.size(); ++i) {
    const double place = 0.1 * static_cast<double>(i);
    places[radius[i]].push_back(place);
    text += fmt::format("{} 2 3 {}\n", place, radius[i]);
  }
  write_durably(path("spheres.xyz"), text);
  const ParticleState particles = placed(start("spheres.xyz")).system.particles;
  std::map<double, std::vector<double>> found;
  for (std::size_t i = 0; i < particles.count(); ++i) {
    EXPECT_EQ(particles.radius[i], of_scene[i]);
    found[particles.radius[i]].push_back(particles.position[i].x);
  }
  EXPECT_EQ(found, places);
  radius[7] = 1.2;
  EXPECT_TRUE(contains(refusal_of_spheres(edge, radius), "must be as in the start, which has"));
}

TEST_F(StartedJob, OfAGsdFileWithoutDiametersSaysSo) {
  gsd::Frames frames;
  frames.add("configuration/box", std::vector<float>{10, 10, 10, 0, 0, 0});
  frames.add_single<std::uint32_t>("particles/N", 60);
  frames.add("particles/position", std::vector<float>(180), 3);
  frames.end_frame();
  write_durably(path("bare.gsd"), frames.head() + frames.pending() + frames.tail());
  EXPECT_TRUE(contains(refusal(scene(start("bare.gsd"))), "must have particles/diameter, which is absent"));
}

TEST_F(StartedJob, OfOneFileIsNoCampaignWithoutNoise) {
  EXPECT_EQ(refusal_of_campaign(scene(start("a.final.xyz"))), "");
  EXPECT_NE(refusal_of_campaign(scene(start("a.final.xyz"), without_noise)), "");
  write_durably(path("starts"), line("a.final.xyz"));
  EXPECT_EQ(refusal_of_campaign(scene(start("starts", "list"), without_noise)), "");
}

TEST_F(StartedJob, OfAListNeedsALineForEverySeedOfTheCampaign) {
  const std::string line = this->line("a.final.xyz");
  write_durably(path("starts"), line + line + line);
  const Scene listed = read_scene(scene(start("starts", "list")), "");
  EXPECT_NO_THROW(check_start_of_campaign(listed, "scene", 3));
  const std::string refusal = refusal_by([&] { check_start_of_campaign(listed, "scene", 4); });
  EXPECT_TRUE(refusal.starts_with("scene: /start/list: ")) << refusal;
  EXPECT_TRUE(contains(refusal, "for each of the 4 seeds"));
}

TEST_F(StartedJob, OfANameThatNoFileCanHaveIsRefused) {
  for (const char* const key : {"file", "list"}) {
    Json named = {{"sha256", std::string(64, 'a')}, {key, "/" + std::string(5000, 'a')}};
    EXPECT_NE(refusal_of_campaign(scene(named)), "") << key;
  }
}

// Seeds 0 and 2 have one file under two names.
TEST_F(StartedJob, OfAListThatHasOneFileTwiceIsNoCampaignWithoutNoise) {
  fs::copy_file(path("a.final.xyz"), path("b.xyz"));
  write_durably(path("starts"), line("a.final.xyz") + line("a.trajectory.gsd") + line("b.xyz"));
  const std::string message = refusal_of_campaign(scene(start("starts", "list"), without_noise));
  EXPECT_TRUE(contains(message, "scene.json: /start/list"));
  EXPECT_TRUE(contains(message, "seed 2 begins at a file of the same hash as seed 0"));
  EXPECT_EQ(refusal_of_campaign(scene(start("starts", "list"))), "") << "with noise";
  write_durably(path("starts"), line("a.final.xyz") + line("a.trajectory.gsd"));
  EXPECT_EQ(refusal_of_campaign(scene(start("starts", "list"), without_noise)), "");
}

// With positions alone velocities are those of the flow plus noise by the seed, as after packing.
TEST_F(StartedJob, WithoutMotionInItsFileBeginsWithThatOfAFreshOne) {
  std::string text = read_file(path("a.final.xyz"));
  const std::string known = "angular_velocity:R:3";
  text.replace(text.find(known), known.size(), "something_else:R:3");
  write_durably(path("still.xyz"), text);
  const Scene scene_ = read_scene(scene(start("still.xyz"), without_noise), "");
  const PlacedSpheres placed = placed_spheres(scene_, 0, "");
  EXPECT_FALSE(placed.in_motion);
  Simulation simulation = simulation_of(scene_, 0);
  simulation.start(placed.system, placed.in_motion);
  const ParticleState& particles = simulation.system().particles;
  for (std::size_t i = 0; i < particles.count(); ++i) {
    EXPECT_NEAR(particles.velocity[i].x, 2 * particles.position[i].y, 1e-12);
    EXPECT_EQ(particles.angular_velocity[i].z, -1);
  }
}

}  // namespace
}  // namespace peclet::engine
