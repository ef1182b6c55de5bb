// A run in oscillating shear ends in the same bits if cut and resumed.
#include <gtest/gtest.h>

#include "engine/observables/scene_reading.h"
#include "engine/realisation/simulation.h"
#include "tests/engine/small_scene.h"

namespace peclet::engine {
namespace {

constexpr std::uint64_t seed_of_run = 3, three_cycles = 3 * 128;

class ResumedOscillation : public testing::TestWithParam<const char*> {
 protected:
  // Strain 0.04 sin(50 t): a cycle has 128 steps, the minimum.
  Scene scene() const {
    return read_scene(
        small_scene(
            {{"flow", {{"shear_rate", nullptr}, {"oscillation", {{"amplitude", 0.04}, {"frequency", 50}}}}},
             {"integrator", {{"method", GetParam()}, {"timestep", 0.001}}},
             {"particles", {{"density", 0.05}}},
             {"duration",
              {{"equilibration", {{"time", nullptr}, {"cycles", 1}}},
               {"production", {{"time", nullptr}, {"cycles", 2}}}}},
             {"observables", {"oscillation"}}}),
        "scene.json");
  }
  std::unique_ptr<Simulation> simulation(int threads = 1) const {
    return std::make_unique<Simulation>(scene(), make_schedule(scene(), "scene.json"), seed_of_run, threads,
                                        "scene.json");
  }
  static std::string bytes_of(const Simulation& simulation) {
    ArchiveWriter archive;
    simulation.save(archive);
    return archive.bytes();
  }
};
INSTANTIATE_TEST_SUITE_P(EitherMethod, ResumedOscillation, testing::Values("explicit", "implicit"),
                         [](const auto& method) { return std::string(method.param); });

TEST_P(ResumedOscillation, EndsAsTheUncutOneWhereverItWasCut) {
  const auto uncut = simulation();
  uncut->start();
  ASSERT_TRUE(uncut->advance(three_cycles).has_value());
  EXPECT_EQ(uncut->system().step, three_cycles);
  for (const std::uint64_t cut : {0U, 57U, 128U, 129U, 300U, 383U}) {  // before, within and between cycles
    const auto before = simulation();
    before->start();
    before->advance(cut);
    ArchiveWriter archive;
    before->save(archive);
    const auto after = simulation(2);
    ArchiveReader reader(archive.bytes());
    after->load(reader);
    EXPECT_TRUE(reader.at_end());
    const std::optional<Ending> ending = after->advance(three_cycles);
    ASSERT_TRUE(ending.has_value());
    EXPECT_EQ(ending->cause, Ending::Cause::completed);
    EXPECT_TRUE(bytes_of(*after) == bytes_of(*uncut)) << "cut at " << cut;
  }
}

// A whole cycle restores the cell.
TEST_P(ResumedOscillation, EndsInTheCellThatItBeganIn) {
  const auto run = simulation();
  run->start();
  run->advance(128 / 4);
  EXPECT_NEAR(run->system().box.displacement_gradient().column[1].x, 0.04, 1e-12);
  run->advance(three_cycles);
  EXPECT_NEAR(run->system().box.displacement_gradient().column[1].x, 0, 1e-12);
}

}  // namespace
}  // namespace peclet::engine
