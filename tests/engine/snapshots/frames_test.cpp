// The published layout of a GSD file, byte by byte.
#include <gtest/gtest.h>

#include "engine/snapshots/gsd_file.h"
#include "tests/engine/snapshots/gsd_reader.h"

namespace peclet::engine {
namespace {

using gsd::Frames;

void add_frame(Frames& frames, float x) {
  frames.add_single<std::uint64_t>("configuration/step", 7);
  frames.add("particles/position", std::vector<float>{x, 2, 3, 4, 5, 6}, 3);
  frames.end_frame();
}

std::string whole(const Frames& frames) { return frames.head() + frames.pending() + frames.tail(); }

TEST(GsdFrames, HaveThePublishedHeader) {
  Frames frames;
  add_frame(frames, 1);
  const std::string bytes = whole(frames);
  EXPECT_EQ(frames.head().size(), 256U);
  // Little-endian.
  EXPECT_EQ(bytes.substr(0, 8), "\xDF\x65\xDF\x65\xDF\x65\xDF\x65");
  EXPECT_EQ(value_at<std::uint32_t>(bytes, 40), 0x00010004U);  // schema 1.4
  EXPECT_EQ(value_at<std::uint32_t>(bytes, 44), 0x00020000U);  // layout 2.0
  const GsdReader file(bytes);
  EXPECT_EQ(file.text(48), "peclet-engine");
  EXPECT_EQ(file.text(112), "hoomd");
  EXPECT_EQ(bytes.substr(176, 80), std::string(80, '\0'));
  // The file has data, names in whole segments, and the index, nothing else.
  const auto names = value_at<std::uint64_t>(bytes, 24), index = value_at<std::uint64_t>(bytes, 8);
  EXPECT_EQ(names, 256U + 8 + 6 * 4);
  EXPECT_EQ(index, names + 64 * value_at<std::uint64_t>(bytes, 32));
  EXPECT_EQ(bytes.size(), index + 32 * value_at<std::uint64_t>(bytes, 16));
  EXPECT_EQ(bytes[index - 1], '\0') << "readers want the last segment of the names to end with a zero";
}

TEST(GsdFrames, HaveAnIndexByFrameAndName) {
  Frames frames;
  add_frame(frames, 1);
  frames.add_single<std::uint64_t>("configuration/step", 8);  // the only chunk
  frames.end_frame();
  add_frame(frames, -1);
  const GsdReader file(whole(frames));
  EXPECT_EQ(file.names(), (std::vector<std::string>{"configuration/step", "particles/position"}));
  ASSERT_EQ(file.chunks().size(), 5U);
  std::uint64_t place = 256;
  const std::uint64_t of_frame[] = {0, 0, 1, 2, 2};
  const std::uint16_t of_name[] = {0, 1, 0, 0, 1};
  for (std::size_t k = 0; k < 5; ++k) {
    const GsdReader::Chunk& chunk = file.chunks()[k];
    const bool is_step = of_name[k] == 0;
    EXPECT_EQ(chunk.frame, of_frame[k]);
    EXPECT_EQ(chunk.name, of_name[k]);
    EXPECT_EQ(chunk.location, place);
    EXPECT_EQ(chunk.rows, is_step ? 1U : 2U);
    EXPECT_EQ(chunk.columns, is_step ? 1U : 3U);
    EXPECT_EQ(chunk.type, is_step ? 4 : 9);  // uint64, float
    EXPECT_EQ(chunk.flags, 0);
    place += is_step ? 8 : 24;
  }
  EXPECT_EQ(file.get<float>(2, "particles/position"), (std::vector<float>{-1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(file.get<std::uint64_t>(1, "configuration/step"), std::vector<std::uint64_t>{8});
}

// Published numbers of types: 1 uint8, 3 uint32, 5 int8, 7 int32, 10 double.
TEST(GsdFrames, NameTheTypesOfValues) {
  Frames frames;
  frames.add_single<std::uint8_t>("a", 1);
  frames.add_single<std::uint32_t>("b", 1);
  frames.add_single<std::int8_t>("c", 1);
  frames.add_single<std::int32_t>("d", 1);
  frames.add_single<double>("e", 1);
  frames.end_frame();
  const GsdReader file(whole(frames));
  const int types[] = {1, 3, 5, 7, 10};
  for (std::size_t k = 0; k < 5; ++k) EXPECT_EQ(file.chunks().at(k).type, types[k]);
}

// An entry with location 0 would end the index.
TEST(GsdFrames, ListAChunkWithoutRows) {
  Frames frames;
  frames.add("bonds/group", std::vector<std::uint32_t>{}, 2);
  frames.end_frame();
  add_frame(frames, 1);
  const GsdReader file(whole(frames));
  EXPECT_EQ(file.chunk(0, "bonds/group").rows, 0U);
  EXPECT_EQ(file.frames(), 2U);
}

TEST(GsdFrames, MayBeNone) {
  const Frames frames;
  const GsdReader file(whole(frames));
  EXPECT_EQ(file.frames(), 0U);
  EXPECT_TRUE(file.names().empty());
}

TEST(GsdFrames, RefuseAnOrderThatTheIndexMayNotHave) {
  Frames frames;
  add_frame(frames, 1);
  frames.add("particles/position", std::vector<float>{1, 2, 3}, 3);
  EXPECT_THROW(frames.add_single<std::uint64_t>("configuration/step", 7), std::logic_error);
  EXPECT_THROW(frames.add("particles/position", std::vector<float>{1, 2, 3}, 3), std::logic_error);
}

TEST(GsdFrames, GoOnFromAnArchiveAsIfTheyHadNotStopped) {
  Frames uncut, before, after;
  for (float x = 0; x < 5; ++x) add_frame(uncut, x);
  add_frame(before, 0);
  const std::string given = before.pending();
  before.hand_over();
  EXPECT_EQ(before.written(), before.length());
  add_frame(before, 1);
  EXPECT_EQ(before.written(), 256 + given.size());
  ArchiveWriter writer;
  before.save(writer);
  ArchiveReader reader(writer.bytes());
  add_frame(after, 99);  // discarded by load()
  after.load(reader);
  EXPECT_TRUE(reader.at_end());
  for (float x = 2; x < 5; ++x) add_frame(after, x);
  EXPECT_EQ(after.head() + given + after.pending() + after.tail(), whole(uncut));
}

}  // namespace
}  // namespace peclet::engine
