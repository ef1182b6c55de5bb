// A realisation on a card has the same bits whatever is beside it, and however often it is interrupted.
#include "engine/realisation/card_ensemble.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>

#include "contract/sha256.h"
#include "engine/realisation/crew.h"
#include "engine/realisation/result.h"
#include "tests/engine/realisation/card_scenes.h"
#include "tests/engine/realisation/small_result.h"
#include "tests/engine/temporary_folder.h"

namespace peclet::engine {
namespace {

// The whole result but its cost, and the state in which a realisation ends.
struct End {
  std::string result, state;
};

End end_of(const Simulation& simulation, const Scene& scene, std::uint64_t seed, const Ending& ending) {
  const std::string state = bytes_of(simulation);
  return {without_cost(
              make_result({"point", seed, "emulated", true}, scene, simulation, ending, sha256(state), {}))
              .dump(),
          state};
}

// Several comparisons with half steps without noise, and several rebuilds of the candidates.
const Json of_some_hundred_steps =
    Json::parse(R"({"particles": {"count": 60}, "integrator": {"timestep": 0.0025, "tolerance": 1e-3},
                    "duration": {"equilibration": {"time": 0.1}, "production": {"time": 0.8}}})");
const std::vector<Json>& interrupted_scenes() {
  static const std::vector<Json> all = {
      card_scene(of_some_hundred_steps),
      card_scene(together({of_some_hundred_steps, without_friction})),
      card_scene(together({of_some_hundred_steps, with_noise})),
      // Ends by its guard.
      card_scene(together({of_some_hundred_steps, Json::parse(R"({"guard": {"largest_overlap": 0.06},
                                                                  "contact": {"normal_stiffness": 2e3}})")})),
  };
  return all;
}

struct Job {
  Scene scene;
  std::uint64_t seed;
  std::unique_ptr<Simulation> simulation;
  std::optional<End> end = {};
};

std::vector<Job> jobs(std::size_t seeds) {
  std::vector<Job> all;
  for (const Json& document : interrupted_scenes()) {
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
      const Scene scene = read_scene(document, "scene.json");
      all.push_back({scene, seed, std::make_unique<Simulation>(simulation_of(scene, seed))});
      all.back().simulation->start();
    }
  }
  return all;
}

// Advances jobs to their ends; calls between() between two calls of advance().
template <class Between>
void run(CardEnsemble& ensemble, std::vector<Job>& all, Between&& between) {
  for (Job& job : all) ensemble.add(*job.simulation);
  for (std::size_t left = all.size(); left > 0;) {
    for (const Ensemble::Ended& ended : ensemble.advance(std::chrono::duration<double>(0.1))) {
      const auto job =
          std::ranges::find(all, ended.simulation, [](const Job& one) { return one.simulation.get(); });
      job->end = end_of(*job->simulation, job->scene, job->seed, ended.ending);
      --left;
    }
    between();
  }
}

constexpr std::size_t seeds = 2;

// Returns the end of each job alone, in order.
const std::vector<Job>& alone() {
  static const std::vector<Job> ended = [] {
    std::vector<Job> all = jobs(seeds);
    for (Job& job : all) {
      std::vector<Job> one;
      one.push_back(std::move(job));
      CardEnsemble ensemble(emulated_card(1));
      run(ensemble, one, [] {});
      job = std::move(one.front());
    }
    return all;
  }();
  return ended;
}

void expect_the_bits_of_each_alone(const std::vector<Job>& all) {
  for (const Job& job : all) {
    const auto same = std::ranges::find_if(alone(), [&](const Job& one) {
      return one.seed == job.seed && one.scene.document == job.scene.document;
    });
    EXPECT_EQ(job.end->result, same->end->result);
    EXPECT_TRUE(job.end->state == same->end->state) << job.seed << ' ' << job.scene.document;
  }
}

TEST(ACardEnsemble, EndsAsItShould) {
  std::size_t completed = 0, broken = 0;
  for (const Job& job : alone()) {
    const Json result = Json::parse(job.end->result);
    (result.at("ending").at("cause") == "completed" ? completed : broken) += 1;
    if (result.at("ending").at("cause") != "completed") {
      EXPECT_EQ(result.at("ending").at("cause"), "overlap") << result.at("ending");
      EXPECT_GT(job.simulation->system().step, job.simulation->schedule().equilibration);
    }
    EXPECT_GT(job.simulation->system().list.builds(), 10U);
  }
  EXPECT_EQ(completed, 3 * seeds);
  EXPECT_EQ(broken, seeds);
}

TEST(ACardEnsemble, HasTheSameBitsInAnyCompany) {
  std::minstd_rand random(5);
  for (int turn = 0; turn < 2; ++turn) {
    std::vector<Job> all = jobs(seeds);
    std::shuffle(all.begin(), all.end(), random);
    CardEnsemble ensemble(emulated_card(all.size()));
    run(ensemble, all, [&] { ensemble.limit_steps(1 + random() % 90); });
    expect_the_bits_of_each_alone(all);
  }
}

TEST(ACardEnsemble, HasTheSameBitsAfterInterruptions) {
  std::minstd_rand random(8);
  for (const std::uint64_t stride : {3U, 60U}) {
    std::vector<Job> all = jobs(1);
    CardEnsemble ensemble(emulated_card(all.size()));
    ensemble.limit_steps(stride);
    std::size_t interruptions = 0;
    run(ensemble, all, [&] {
      for (Job& job : all) {
        if (job.end || random() % (stride == 3 ? 20 : 2) != 0) continue;
        ++interruptions;
        ensemble.remove(*job.simulation);
        const std::string checkpoint = bytes_of(*job.simulation);
        job.simulation = std::make_unique<Simulation>(simulation_of(job.scene, job.seed));
        load(*job.simulation, checkpoint);
        ensemble.add(*job.simulation);
      }
    });
    EXPECT_GT(interruptions, 10U);
    expect_the_bits_of_each_alone(all);
  }
}

TEST(ACardEnsemble, HasTheSameBitsInLittleRoom) {
  std::minstd_rand random(11);
  std::vector<Job> all = jobs(1);
  CardEnsemble ensemble(emulated_card(all.size()));
  ensemble.begin_with_room({.pairs = 3, .neighbours = 1});
  ensemble.limit_steps(40);
  run(ensemble, all, [&] {
    for (Job& job : all) {
      if (job.end || random() % 4 != 0) continue;
      ensemble.remove(*job.simulation);
      ensemble.add(*job.simulation);
    }
  });
  expect_the_bits_of_each_alone(all);
}

// The jobs of a crew wait for places, and go on from checkpoints of their own.
TEST(ACardEnsemble, HasTheSameBitsInACrewOfAnySize) {
  const TemporaryFolder folder;
  for (const std::size_t places : {1U, 2U, 4U}) {
    std::mutex mutex;
    std::map<std::string, std::string> results;
    CardEnsemble ensemble(emulated_card(places));
    {
      Crew crew(ensemble, Device::emulated);
      for (const Job& job : alone()) {
        crew.begin([&] {
          JobSpecification one = job_of(job.scene.document, "", job.seed);
          one.checkpoint = folder / (std::to_string(places) + sha256(job.end->result));
          one.checkpoint_seconds = 0.2;
          const std::optional<Json> result = crew.run(one, {});
          const std::lock_guard lock(mutex);
          results[job.end->result] = without_cost(*result).dump();
        });
      }
      while (crew.active() > 0) crew.turn();
    }
    EXPECT_EQ(results.size(), alone().size());
    for (const auto& [expected, result] : results) {
      // The other keys of a result tell of the state, whose file has another name.
      for (const char* const key :
           {"mean", "blocks", "method", "largest_overlap", "inefficiencies", "steps", "warnings"}) {
        EXPECT_EQ(Json::parse(result).value(key, Json()), Json::parse(expected).value(key, Json())) << key;
      }
      EXPECT_EQ(Json::parse(result).at("ending").at("message"),
                Json::parse(expected).at("ending").at("message"));
    }
  }
}

// A scene beyond a card is refused with its place in the scene.
TEST(ACardEnsemble, RefusesWhatItCannotDo) {
  struct Case {
    const char* patch;
    const char *pointer, *value, *allowed;
  };
  const char* const steady = "must be steady shear for a card";
  CardEnsemble ensemble(emulated_card(3));
  for (
      const auto& [patch, pointer, value, allowed] : {
          Case{R"({"integrator": {"method": "explicit", "tolerance": null}})", "/integrator/method",
               R"("explicit")", "must be implicit for a card"},
          Case{R"({"particles": {"count": 4097}})", "/particles/count", "4097",
               "must be at most 4096 for a card"},
          Case{R"({"flow": {"shear_rate": null, "extension_rate": 0.5}})", "/flow",
               R"({"extension_rate":0.5})", steady},
          Case{R"({"flow": {"shear_rate": null, "uniaxial_rate": 0.01}})", "/flow",
               R"({"uniaxial_rate":0.01})", steady},
          Case{R"({"flow": {"shear_rate": null, "stress": 1}})", "/flow", R"({"stress":1})", steady},
          Case{R"({"flow": {"shear_rate": null, "oscillation": {"amplitude": 1, "frequency": 1}}})", "/flow",
               R"({"oscillation":{"amplitude":1,"frequency":1}})", steady},
          Case{R"({"flow": {"shear_rate": 1, "cross_shear": {"amplitude": 1, "frequency": 1}}})", "/flow",
               R"({"cross_shear":{"amplitude":1,"frequency":1},"shear_rate":1})", steady},
          Case{
              R"({"flow": {"shear_rate": null, "segments": [{"shear_rate": 1, "strain": 1}, {"shear_rate": -1}]}})",
              "/flow", R"({"segments":[{"shear_rate":1,"strain":1},{"shear_rate":-1}]})", steady},
          Case{R"({"flow": {"waves": [{"periods": 1, "sine": 0.1}], "faxen": false}})", "/flow",
               R"({"faxen":false,"shear_rate":2,"waves":[{"cosine":0,"perio...)", steady},
          Case{R"({"observables": ["fabric"]})", "/observables", R"(["fabric"])",
               "must be absent: stress, contacts and temperatures only for a card"},
          Case{R"({"box": {"height": 9}})", "/box", R"({"height":9})", "must be absent: a cube for a card"},
      }) {
    SCOPED_TRACE(patch);
    const Scene scene = read_scene(card_scene(Json::parse(patch)), "scene.json");
    const std::optional<InputError> refusal = ensemble.refusal(scene, "scene.json");
    ASSERT_TRUE(refusal.has_value());
    EXPECT_EQ(refusal->pointer(), pointer);
    EXPECT_EQ(refusal->value(), value);
    EXPECT_EQ(refusal->allowed(), allowed);
    EXPECT_EQ(ensemble.capacity(scene), 0U);
  }
  const Scene largest =
      read_scene(card_scene(Json::parse(R"({"particles": {"count": 4096}})")), "scene.json");
  EXPECT_FALSE(ensemble.refusal(largest, "scene.json"));
  EXPECT_EQ(ensemble.capacity(largest), 3U);
}

// The sizes are those of the spheres, whether species list them or distributions.
TEST(ACardEnsemble, RefusesMoreThan64Sizes) {
  const CardEnsemble ensemble(emulated_card(1));
  const auto refusal = [&](const Json& species) {
    const Scene scene = read_scene(
        card_scene({{"particles", {{"count", 3000}, {"species", species}}}, {"volume_fraction", 0.2}}),
        "scene.json");
    return ensemble.refusal(scene, "scene.json");
  };
  const auto species = [](std::size_t sizes, std::size_t of_each) {
    Json all = Json::array();
    for (std::size_t k = 0; k < sizes * of_each; ++k) {
      all.push_back({{"radius", 1 + 0.01 * static_cast<double>(k % sizes)}, {"number_share", 1}});
    }
    return all;
  };
  EXPECT_FALSE(refusal(species(64, 1)));
  EXPECT_FALSE(refusal(species(40, 2)));
  const std::optional<InputError> refused = refusal(species(65, 1));
  ASSERT_TRUE(refused.has_value());
  EXPECT_EQ(refused->pointer(), "/particles/species");
  EXPECT_EQ(refused->allowed(), "must be at most 64 sizes for a card");
  const auto distribution = [](int classes) {
    return Json{{{"distribution",
                  {{"form", "lognormal"},
                   {"by", "number"},
                   {"mean_radius", 1},
                   {"relative_width", 0.1},
                   {"classes", classes}}},
                 {"number_share", 1}}};
  };
  EXPECT_FALSE(refusal(distribution(20)));
}

// Scenes that a card cannot run have the processor's bits where the device is chosen automatically.
TEST(ACardEnsemble, LeavesOtherScenesToTheProcessor) {
  const Json scene = small_scene();
  CardEnsemble ensemble(emulated_card(2));
  Json result;
  Crew crew(ensemble, Device::automatic);
  crew.begin([&] { result = crew.run(job_of(scene, "", usual_seed), {}).value(); });
  while (crew.active() > 0) crew.turn();
  Json expected = usual_result();
  EXPECT_EQ(result.at("engine").at("device"), "processor");
  for (Json* const one : {&result, &expected}) one->erase("engine");
  EXPECT_EQ(without_cost(result), without_cost(expected));
}

}  // namespace
}  // namespace peclet::engine
