// Runs in time-dependent flows end in the same bits if cut and resumed, on any number of threads.
#include <gtest/gtest.h>

#include "engine/observables/scene_reading.h"
#include "engine/realisation/simulation.h"
#include "tests/engine/small_scene.h"

namespace peclet::engine {
namespace {

struct Case {
  const char *name, *flow, *observable, *method;
};

const char* const reversal =
    R"({"segments": [{"shear_rate": 2, "time": 0.2013}, {"shear_rate": -2, "final_rate": 1, "time": 0.2},
                     {"shear_rate": 0}]})";
const char* const across = R"({"shear_rate": 2, "cross_shear": {"amplitude": 0.05, "frequency": 20}})";

const Case cases[] = {{"reversal", reversal, "transient", "explicit"},
                      {"reversal_implicit", reversal, "transient", "implicit"},
                      {"across", across, "contact_network", "explicit"},
                      {"across_implicit", across, "contact_network", "implicit"},
                      {"extension", R"({"extension_rate": 1})", "transient", "explicit"},
                      {"extension_implicit", R"({"extension_rate": 1})", "transient", "implicit"},
                      {"uniaxial", R"({"uniaxial_rate": 1})", "transient", "explicit"},
                      {"biaxial_implicit", R"({"uniaxial_rate": -1})", "transient", "implicit"}};

class ResumedFlow : public testing::TestWithParam<Case> {
 protected:
  std::unique_ptr<Simulation> simulation(int threads = 1) const {
    Json document = small_scene({{"particles", {{"density", 0.05}}}});
    document["flow"] = Json::parse(GetParam().flow);
    document["duration"]["production"]["time"] = 0.24;
    document["observables"] = {GetParam().observable};
    document["integrator"] = {{"method", GetParam().method}, {"timestep", 0.0008}};
    const Scene scene = read_scene(document, "scene.json");
    return std::make_unique<Simulation>(scene, make_schedule(scene, "scene.json"), 3, threads, "scene.json");
  }
  static std::string bytes_of(const Simulation& simulation) {
    ArchiveWriter archive;
    simulation.save(archive);
    return archive.bytes();
  }
};
INSTANTIATE_TEST_SUITE_P(OfEachKind, ResumedFlow, testing::ValuesIn(cases),
                         [](const auto& each) { return std::string(each.param.name); });

TEST_P(ResumedFlow, EndsAsTheUncutOneWhereverItWasCut) {
  const auto uncut = simulation();
  uncut->start();
  const std::optional<Ending> ending = uncut->advance(uncut->schedule().total());
  ASSERT_EQ(ending->cause, Ending::Cause::completed) << ending->message;
  for (const std::uint64_t cut : {0U, 157U, 251U, 252U, 450U}) {
    const auto before = simulation();
    before->start();
    before->advance(cut);
    ArchiveWriter archive;
    before->save(archive);
    const auto after = simulation(/*threads=*/cut == 450 ? 2 : 1);
    ArchiveReader reader(archive.bytes());
    after->load(reader);
    EXPECT_TRUE(reader.at_end());
    after->advance(uncut->schedule().total());
    EXPECT_TRUE(bytes_of(*after) == bytes_of(*uncut)) << "cut at " << cut;
  }
}

}  // namespace
}  // namespace peclet::engine
