// Frames of the schema "hoomd", as this program and others write them.
#include "engine/snapshots/gsd_snapshots.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "contract/durable_file.h"
#include "contract/input_error.h"
#include "engine/gsd/frames.h"
#include "engine/snapshots/snapshot_file.h"
#include "tests/engine/temporary_folder.h"

namespace peclet::engine {
namespace {

using gsd::Frames;

class GsdSnapshot : public testing::Test {
 protected:
  // What `add` puts into each of two frames, of two spheres unless it says otherwise.
  Snapshot read(std::uint64_t frame, const std::function<void(Frames&, int)>& add) const {
    Frames frames;
    for (int k = 0; k < 2; ++k) {
      add(frames, k);
      frames.end_frame();
    }
    write_durably(path_, frames.head() + frames.pending() + frames.tail());
    return read_gsd_frame(gsd::Reader(path_), frame);
  }
  std::string refusal(const std::function<void(Frames&, int)>& add) const {
    try {
      read(1, add);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  static void add_least(Frames& frames, int k) {
    frames.add("configuration/box", std::vector<float>{10, 20, 40, 0.25F, -0.5F, 0.125F});
    frames.add_single<std::uint32_t>("particles/N", 2);
    const auto x = static_cast<float>(k);
    frames.add("particles/position", std::vector<float>{x, 2, 3, 4, 5, 6}, 3);
  }

  TemporaryFolder folder_;
  std::filesystem::path path_ = folder_ / "t.gsd";
};

TEST_F(GsdSnapshot, HasTheCellThatTheSchemaSays) {
  const Snapshot snapshot = read(1, add_least);
  const Matrix3 lattice = {Vector3{10, 0, 0}, Vector3{5, 20, 0}, Vector3{-20, 5, 40}};
  EXPECT_TRUE(snapshot.lattice == lattice);
  EXPECT_TRUE(snapshot.corner == (Vector3{2.5, -12.5, -20}));  // its centre is the origin
  EXPECT_TRUE(snapshot.position[0] == (Vector3{1, 2, 3}));
  EXPECT_TRUE(snapshot.single);
}

TEST_F(GsdSnapshot, WithoutMoreHasTheDefaultsOfTheSchema) {
  const Snapshot snapshot = read(1, add_least);
  EXPECT_EQ(snapshot.radius, (std::vector<double>{0.5, 0.5}));
  EXPECT_EQ(snapshot.species, (std::vector<std::uint32_t>{0, 0}));
  EXPECT_EQ(snapshot.species_names, std::vector<std::string>{"A"});
  EXPECT_TRUE(snapshot.velocity.empty() && snapshot.stress.empty() && !snapshot.contacts && !snapshot.strain);
}

TEST_F(GsdSnapshot, TakesFromTheFirstFrameWhatItLacks) {
  const auto add = [](Frames& frames, int k) {
    add_least(frames, k);
    if (k == 0) {
      frames.add("particles/types", std::vector<std::int8_t>{'A', 0, 'B', 'b'}, 2);
      frames.add("particles/typeid", std::vector<std::uint32_t>{1, 0});
      frames.add("particles/diameter", std::vector<float>{2, 2.8F});
      frames.add("bonds/group", std::vector<std::uint32_t>{0, 1}, 2);
      frames.add("log/bonds/normal_force", std::vector<float>{3});
      frames.add("log/bonds/tangential_force", std::vector<float>{4});
    }
  };
  const Snapshot snapshot = read(1, add);
  EXPECT_EQ(snapshot.radius, (std::vector<double>{1, 0.5 * double{2.8F}}));
  EXPECT_EQ(snapshot.species_names, (std::vector<std::string>{"A", "Bb"}));
  EXPECT_EQ(snapshot.species, (std::vector<std::uint32_t>{1, 0}));
  EXPECT_FALSE(snapshot.contacts) << "contacts are of one moment";
  const Snapshot first = read(0, add);
  ASSERT_EQ(first.contacts->size(), 1U);
  EXPECT_EQ(first.contacts->front().normal_force, 3);
}

TEST_F(GsdSnapshot, OfWhatTheSchemaForbidsIsRefused) {
  const auto with = [](const std::function<void(Frames&)>& more) {
    return [more](Frames& frames, int k) {
      add_least(frames, k);
      more(frames);
    };
  };
  const auto expect = [&](const std::function<void(Frames&, int)>& add, const std::string& reason) {
    EXPECT_NE(refusal(add).find(reason), std::string::npos) << refusal(add) << " has not " << reason;
  };
  expect([](Frames& frames, int) { frames.add_single<std::uint32_t>("particles/N", 0); },
         "particles/N of frame 1: 0");
  expect([](Frames& frames, int) { frames.add_single<std::uint32_t>("particles/N", 4'000'000'000U); },
         "must be 1 to");
  expect([](Frames& frames, int) { frames.add_single<std::uint32_t>("particles/N", 2); },
         "configuration/box");
  expect(with([](Frames& frames) { frames.add("particles/diameter", std::vector<float>{1}); }),
         "one for each of 2");
  expect(with([](Frames& frames) {
           frames.add("particles/diameter", std::vector<float>{1, 0});
         }),
         "must be > 0");
  const float nan = std::numeric_limits<float>::quiet_NaN();
  expect(with([&](Frames& frames) {
           frames.add("particles/diameter", std::vector<float>{1, nan});
         }),
         "must be finite");
  expect(with([](Frames& frames) {
           frames.add("particles/typeid", std::vector<std::uint32_t>{0, 1});
         }),
         "below 1");
  expect(with([](Frames& frames) {
           frames.add("bonds/group", std::vector<std::uint32_t>{0, 2}, 2);
           frames.add("log/bonds/normal_force", std::vector<float>{3});
           frames.add("log/bonds/tangential_force", std::vector<float>{4});
         }),
         "must be below 2");
  expect(
      [](Frames& frames, int) {
        frames.add("configuration/box", std::vector<float>{10, -20, 40, 0, 0, 0});
        frames.add_single<std::uint32_t>("particles/N", 1);
      },
      "lengths > 0");
}

TEST_F(GsdSnapshot, IsChosenByRangesThatIncludeBothEnds) {
  Frames frames;
  for (int k = 0; k < 10; ++k) {
    add_least(frames, k);
    frames.end_frame();
  }
  write_durably(path_, frames.head() + frames.pending() + frames.tail());
  const SnapshotFile file(path_);
  using Numbers = std::vector<std::uint64_t>;
  for (const auto& [range, expected] : std::vector<std::pair<std::string, Numbers>>{{"3", {3}},
                                                                                    {"-1", {9}},
                                                                                    {"-3:", {7, 8, 9}},
                                                                                    {":2", {0, 1, 2}},
                                                                                    {"1:9:3", {1, 4, 7}},
                                                                                    {"::4", {0, 4, 8}},
                                                                                    {"2:-8", {2}},
                                                                                    {"0:-1:99", {0}}}) {
    EXPECT_EQ(chosen_frames(range, file, "--frames"), expected) << range;
  }
  for (const char* range : {"", "10", "-11", "x", "1:2:3:4", "5:4", "0:9:0", "0:9:-1", "1.5", "0:99", " 1"}) {
    EXPECT_THROW(chosen_frames(range, file, "--frames"), InputError) << range;
  }
}

}  // namespace
}  // namespace peclet::engine
