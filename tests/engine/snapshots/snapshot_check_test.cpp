// Values that files may give for spheres, and values that cannot be computed with.
#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "engine/snapshots/snapshot.h"
#include "tests/contract/refusal.h"

namespace peclet::engine {
namespace {

Snapshot touching() {
  Snapshot snapshot;
  snapshot.lattice = {Vector3{10, 0, 0}, Vector3{2, 10, 0}, Vector3{0, 0, 10}};
  snapshot.position = {{1, 1, 1}, {2.9, 1, 1}};
  snapshot.radius = {1, 1};
  snapshot.species = {0, 0};
  snapshot.species_names = {"A"};
  snapshot.velocity = snapshot.spin = {{1, 0, 0}, {0, 1, 0}};
  snapshot.stress = {{1, 2, 3, 4, 5, 6}, {1, 2, 3, 4, 5, 6}};
  snapshot.stress_of_cell["total"] = {1, 2, 3, 4, 5, 6};
  snapshot.time = 3;
  snapshot.strain = 1;
  snapshot.velocity_gradient = simple_shear(2);
  snapshot.contacts = {{0, 1, 5, 0.5}};
  return snapshot;
}

std::string refusal(const Snapshot& snapshot) {
  return refusal_by([&] { check_snapshot(snapshot, "t.xyz"); });
}

const double nan_ = std::numeric_limits<double>::quiet_NaN(),
             infinite = std::numeric_limits<double>::infinity();

TEST(SnapshotCheck, TakesWhatCanBeComputedWith) {
  EXPECT_EQ(refusal(touching()), "");
  for (const auto& change : std::vector<std::function<void(Snapshot&)>>{
           [](Snapshot& s) { s.position[1].x -= 1e5 * 10; },  // unwrapped
           [](Snapshot& s) { s.velocity[1].x = 1e-300; },
           [](Snapshot& s) { s.contacts->front().normal_force = 0; }, [](Snapshot& s) { s.time = 0; },
           [](Snapshot& s) { s.lattice.column[2].z = -10; },  // left-handed
           [](Snapshot& s) {                                  // rotated, as by extension
             s.lattice = {Vector3{-7, -5.6, 0}, Vector3{4.4, -9, 0}, Vector3{0, 0, 9.4}};
           }}) {
    Snapshot snapshot = touching();
    change(snapshot);
    EXPECT_EQ(refusal(snapshot), "");
  }
}

TEST(SnapshotCheck, RefusesPlacesAndNumbersThatAreNone) {
  for (const double bad : {nan_, infinite, -infinite, 1e300, -1e31}) {
    for (const auto& [number, name] : std::vector<std::pair<std::function<double&(Snapshot&)>, std::string>>{
             {[](Snapshot& s) -> double& { return s.position[1].z; }, "t.xyz: sphere 1 at ("},
             {[](Snapshot& s) -> double& { return s.corner.y; }, "t.xyz: corner of the cell at ("},
             {[](Snapshot& s) -> double& { return s.lattice.column[1].x; }, "t.xyz: cell ("},
             {[](Snapshot& s) -> double& { return s.lattice.column[2].z; }, "t.xyz: cell ("},
             {[](Snapshot& s) -> double& { return s.lattice.column[0].x; }, "t.xyz: cell ("},
             {[](Snapshot& s) -> double& { return s.radius[1]; }, "t.xyz: radius "},
             {[](Snapshot& s) -> double& { return s.velocity[1].x; }, "t.xyz: velocity ("},
             {[](Snapshot& s) -> double& { return s.spin[0].y; }, "t.xyz: angular velocity ("},
             {[](Snapshot& s) -> double& { return s.stress[1].xy; }, "t.xyz: stress of sphere 1 "},
             {[](Snapshot& s) -> double& { return s.stress_of_cell["total"].yz; }, "t.xyz: stress total "},
             {[](Snapshot& s) -> double& { return *s.time; }, "t.xyz: time "},
             {[](Snapshot& s) -> double& { return *s.strain; }, "t.xyz: strain "},
             {[](Snapshot& s) -> double& { return s.velocity_gradient->column[1].x; },
              "t.xyz: velocity gradient "},
             {[](Snapshot& s) -> double& { return s.contacts->front().normal_force; },
              "t.xyz: contact of 0 "},
             {[](Snapshot& s) -> double& { return s.contacts->front().tangential_force; },
              "t.xyz: contact of 0 "}}) {
      Snapshot snapshot = touching();
      number(snapshot) = bad;
      EXPECT_TRUE(refusal(snapshot).starts_with(name)) << bad << ": " << refusal(snapshot);
    }
  }
}

TEST(SnapshotCheck, RefusesWhatIsOutOfProportion) {
  for (const auto& [change, name] : std::vector<std::pair<std::function<void(Snapshot&)>, std::string>>{
           {[](Snapshot& s) { s.position[0].x = 1.1e7; }, "sphere 0 at ("},
           {[](Snapshot& s) { s.radius[0] = 1e-6; }, "radius 1e-06 of sphere 0"},
           {[](Snapshot& s) { s.radius[0] = 11; }, "radius 11 of sphere 0"},
           {[](Snapshot& s) { s.radius[0] = 0; }, "radius 0 of sphere 0"},
           {[](Snapshot& s) { s.lattice.column[1] = 2 * s.lattice.column[0]; }, "cell ("},
           {[](Snapshot& s) { s.lattice.column[2].z = 0; }, "cell ("},
           {[](Snapshot& s) { s.lattice.column[2].z = 1e-6; }, "cell ("},
           {[](Snapshot& s) { s.time = 1e-40; }, "time 1e-40"},
           {[](Snapshot& s) { s.stress_of_cell["a b"] = {}; }, "stress a b"},
           {[](Snapshot& s) { s.contacts->front().second = 0; }, "contact of 0 and 0"},
           {[](Snapshot& s) { s.contacts->front().second = 2; }, "contact of 0 and 2"},
           {[](Snapshot& s) { s.contacts->front().normal_force = -1; }, "contact of 0 and 1"}}) {
    Snapshot snapshot = touching();
    change(snapshot);
    EXPECT_TRUE(refusal(snapshot).starts_with("t.xyz: " + name)) << name << ": " << refusal(snapshot);
  }
}

TEST(SnapshotCheck, SaysThatSizesAreADefault) {
  Snapshot snapshot = touching();
  snapshot.has_sizes = false;
  snapshot.lattice = {Vector3{0.1, 0, 0}, Vector3{0, 0.1, 0}, Vector3{0, 0, 0.1}};
  EXPECT_TRUE(contains(refusal(snapshot), "the file has no diameters"));
}

}  // namespace
}  // namespace peclet::engine
