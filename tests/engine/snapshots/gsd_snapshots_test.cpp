// Frames of the schema "hoomd", written by this program and by others.
#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <limits>

#include "contract/durable_file.h"
#include "engine/snapshots/gsd_file.h"
#include "engine/snapshots/snapshot.h"
#include "tests/contract/refusal.h"
#include "tests/engine/snapshots/gsd_reader.h"
#include "tests/engine/temporary_folder.h"

namespace peclet::engine {
namespace {

using gsd::Frames;

class GsdSnapshot : public testing::Test {
 protected:
  // Returns one of two frames; `add` writes the content of each, two spheres unless stated.
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
    return refusal_by([&] { read(1, add); });
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
  EXPECT_TRUE(snapshot.corner == (Vector3{2.5, -12.5, -20}));  // centred at the origin
  EXPECT_TRUE(snapshot.position[0] == (Vector3{1, 2, 3}));
  EXPECT_TRUE(snapshot.single);
}

TEST_F(GsdSnapshot, WithoutMoreHasTheDefaultsOfTheSchema) {
  const Snapshot snapshot = read(1, add_least);
  EXPECT_EQ(snapshot.radius, (std::vector<double>{0.5, 0.5}));
  EXPECT_EQ(snapshot.species, (std::vector<std::uint32_t>{0, 0}));
  EXPECT_EQ(snapshot.species_names, std::vector<std::string>{"A"});
  EXPECT_FALSE(snapshot.has_sizes);
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
  EXPECT_TRUE(snapshot.has_sizes);
  EXPECT_EQ(snapshot.species_names, (std::vector<std::string>{"A", "Bb"}));
  EXPECT_EQ(snapshot.species, (std::vector<std::uint32_t>{1, 0}));
  EXPECT_FALSE(snapshot.contacts) << "contacts are of one moment";
  const Snapshot first = read(0, add);
  ASSERT_EQ(first.contacts->size(), 1U);
  EXPECT_EQ(first.contacts->front().normal_force, 3);
}

TEST_F(GsdSnapshot, OfWhatTheSchemaForbidsIsRefused) {
  // Returns frames of the least content, with a list of more.
  const auto with = []<class Value>(const char* name, const std::vector<Value>& values) {
    return [=](Frames& frames, int k) {
      add_least(frames, k);
      frames.add(name, values);
    };
  };
  const auto count_of = [](std::uint32_t count) {
    return [count](Frames& frames, int) { frames.add_single<std::uint32_t>("particles/N", count); };
  };
  const auto box = [](const std::vector<float>& edges) {
    return [edges](Frames& frames, int) {
      frames.add("configuration/box", edges);
      frames.add_single<std::uint32_t>("particles/N", 1);
    };
  };
  const auto contact_beyond = [](Frames& frames, int k) {
    add_least(frames, k);
    frames.add("bonds/group", std::vector<std::uint32_t>{0, 2}, 2);
    frames.add("log/bonds/normal_force", std::vector<float>{3});
    frames.add("log/bonds/tangential_force", std::vector<float>{4});
  };
  using Floats = std::vector<float>;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const auto& [add, reason] : std::vector<std::pair<std::function<void(Frames&, int)>, std::string>>{
           {count_of(0), "particles/N of frame 1: 0"},
           {count_of(4'000'000'000U), "must be 1 to"},
           {count_of(2), "configuration/box"},
           {with("particles/diameter", Floats{1}), "one for each of 2"},
           {with("particles/diameter", Floats{1, 0}), "must be > 0"},
           {with("particles/diameter", Floats{1, nan}), "nan: must be > 0"},
           {with("particles/typeid", std::vector<std::uint32_t>{0, 1}), "below 1"},
           {contact_beyond, "contact of 0 and 2: forces 3 and 4: must be of two different spheres below 2"},
           {box({10, -20, 40, 0, 0, 0}), "lengths 10, -20 and 40: must be three lengths > 0"},
           {box({10, 20, 0, 0, 0, 0}),
            "lengths 10, 20 and 0: must be > 0: with Lz = 0 the file has two dimensions"}}) {
    EXPECT_TRUE(contains(refusal(add), reason));
  }
}

// A GSD file has at most 65 536 names, the range of its index entries.
TEST_F(GsdSnapshot, OfManyNamesIsReadInATimeThatGrowsAsTheyDo) {
  Frames frames;
  add_least(frames, 0);
  frames.end_frame();
  const std::string head = frames.head(), tail = frames.tail();
  const auto names = value_at<std::uint64_t>(head, 24), segments = value_at<std::uint64_t>(head, 32);
  const auto with_names = [&](std::size_t more) {
    std::string list = tail.substr(0, 64 * segments);
    list.resize(list.find_last_not_of('\0') + 2);
    for (std::size_t k = 0; k < more; ++k) list += "log/stress/" + std::to_string(k) + '\0';
    list.resize((list.size() / 64 + 1) * 64, '\0');
    std::string whole = head + frames.pending() + list + tail.substr(64 * segments);
    const std::uint64_t now = list.size() / 64, index = names + list.size();
    std::memcpy(whole.data() + 32, &now, sizeof now);
    std::memcpy(whole.data() + 8, &index, sizeof index);
    write_durably(path_, whole);
  };
  with_names(65'000);
  const auto begin = std::chrono::steady_clock::now();
  const gsd::Reader reader(path_);
  EXPECT_EQ(reader.names().size(), 65'003U);
  EXPECT_EQ(read_gsd_frame(reader, 0).count(), 2U);
  // Comparing each name with all earlier ones would take 10 s.
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(2));
  with_names(80'000);
  EXPECT_THROW(gsd::Reader{path_}, InputError);
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
  const std::pair<const char*, Numbers> ranges[] = {
      {"3", {3}},           {"-1", {9}},        {"-3:", {7, 8, 9}}, {":2", {0, 1, 2}},
      {"1:9:3", {1, 4, 7}}, {"::4", {0, 4, 8}}, {"2:-8", {2}},      {"0:-1:99", {0}}};
  for (const auto& [range, expected] : ranges) {
    EXPECT_EQ(chosen_frames(range, file, "--frames"), expected) << range;
  }
  for (const char* range : {"", "10", "-11", "x", "1:2:3:4", "5:4", "0:9:0", "0:9:-1", "1.5", "0:99", " 1"}) {
    EXPECT_THROW(chosen_frames(range, file, "--frames"), InputError) << range;
  }
}

}  // namespace
}  // namespace peclet::engine
