// Which observables a scene may ask for, and when they are measured.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "contract/input_error.h"
#include "engine/catalogue/catalogue.h"
#include "engine/scene/observable_keys.h"
#include "tests/engine/observables/loose_spheres.h"

namespace peclet::engine {
namespace {

// The scene's keys and what is done for them are lists of their own, joined by name.
TEST(Observables, ThatASceneMayListAreThoseThatAreMeasured) {
  std::vector<std::string> listed, measured;
  for (const ObservableEntry& entry : observable_entries()) listed.push_back(entry.name);
  for (const ObservableKind& kind : observable_kinds()) measured.emplace_back(kind.name);
  std::ranges::sort(listed);
  std::ranges::sort(measured);
  EXPECT_EQ(listed, measured);
  EXPECT_EQ(std::ranges::adjacent_find(measured), measured.end());
}

TEST(Observables, AreAbsentUnlessAskedFor) {
  const System system = loose_spheres(2);
  EXPECT_TRUE(
      make_observables(read_scene(small_scene(), "scene.json"), system, {timestep, 256, {edge, edge, edge}})
          .empty());
}

TEST(Observables, NeedAWindowWithSamples) {
  const Scene scene = scene_with("mean_squared_displacement", {{"interval", 20}});
  EXPECT_THROW(check_observables(scene, {timestep, 256, {edge, edge, edge}}, "scene.json"),
               InputError);                                                                      // 7 samples
  EXPECT_NO_THROW(check_observables(scene, {timestep, 281, {edge, edge, edge}}, "scene.json"));  // 8
}

}  // namespace
}  // namespace peclet::engine
