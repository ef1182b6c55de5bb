// A trajectory on disk: frames that are kept or cut off, and damage that is detected.
#include "engine/realisation/growing_file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>

#include "contract/durable_file.h"
#include "engine/realisation/checkpoint.h"
#include "tests/contract/refusal.h"
#include "tests/engine/snapshots/gsd_reader.h"
#include "tests/engine/temporary_folder.h"

namespace peclet::engine {
namespace {

void add_frame(gsd::Frames& frames, double x) {
  frames.add("values", std::vector<double>(100, x));
  frames.end_frame();
}

gsd::Frames copy_of(const gsd::Frames& frames) {
  ArchiveWriter writer;
  frames.save(writer);
  gsd::Frames copy;
  ArchiveReader reader(writer.bytes());
  copy.load(reader);
  return copy;
}

class Growing : public testing::Test {
 protected:
  Growing() {
    GrowingFile file(path_);
    file.go_on(frames_);
    for (const double x : {1, 2, 3}) add_frame(frames_, x);
    file.take(frames_);
    file.synchronise();
  }

  void overwrite(std::size_t place, const std::string& bytes) const {
    std::string all = read_file(path_);
    write_durably(path_, all.replace(place, bytes.size(), bytes));
  }

  const TemporaryFolder folder_;
  const std::filesystem::path path_ = folder_ / "seed.checkpoint@growing", target_ = folder_ / "out.gsd";
  gsd::Frames frames_;
};

TEST_F(Growing, ForgetsWhatCameAfterTheCheckpoint) {
  gsd::Frames checkpoint = copy_of(frames_), lost = copy_of(frames_);
  {
    GrowingFile file(path_);
    file.go_on(lost);
    for (const double x : {-4, -5, -6}) add_frame(lost, x);
    file.take(lost);
    file.finish(lost, folder_ / "lost.gsd");  // killed before its result
  }
  GrowingFile file(path_);
  file.go_on(checkpoint);
  add_frame(checkpoint, 4);
  file.take(checkpoint);
  file.finish(checkpoint, target_);
  const GsdReader read(read_file(target_));
  ASSERT_EQ(read.frames(), 4U);
  for (std::uint64_t k = 0; k < 4; ++k) {
    EXPECT_EQ(read.get<double>(k, "values"), std::vector<double>(100, static_cast<double>(k + 1)));
  }
}

// The engine of a runner that has ended may run on for some seconds.
TEST_F(Growing, IsTheSameWhereTwoEnginesWriteIt) {
  gsd::Frames one = copy_of(frames_), other = copy_of(frames_);
  GrowingFile first(path_), second(path_);
  first.go_on(one);
  add_frame(one, 4);
  add_frame(one, 5);
  first.take(one);
  second.go_on(other);
  add_frame(one, 6);
  first.take(one);
  first.finish(one, folder_ / "first.gsd");
  for (const double x : {4, 5, 6}) {
    add_frame(other, x);
    second.take(other);
  }
  second.finish(other, target_);
  EXPECT_EQ(read_file(target_), read_file(folder_ / "first.gsd"));
}

TEST_F(Growing, SaysWhichFrameIsDamagedOrAbsent) {
  const std::uint64_t second = frames_.whole()[1].begin;
  overwrite(second + 5, "x");
  GrowingFile file(path_);
  EXPECT_TRUE(contains(refusal_by<CheckpointError>([&] { file.go_on(frames_); }), "frame 1 is damaged"));
  EXPECT_THROW(file.finish(frames_, target_), IntegrityError);
  EXPECT_FALSE(std::filesystem::exists(target_));
  std::filesystem::resize_file(path_, second);
  EXPECT_TRUE(
      contains(refusal_by<CheckpointError>([&] { GrowingFile(path_).go_on(frames_); }), "has no frame 1"));
}

TEST_F(Growing, LeavesNothingWithoutAName) {
  const std::filesystem::path path = folder_ / "none.tmp";
  gsd::Frames frames;
  GrowingFile file(path, /*has_name=*/false);
  file.go_on(frames);
  add_frame(frames, 1);
  file.take(frames);
  EXPECT_FALSE(std::filesystem::exists(path));
  file.finish(frames, target_);
  EXPECT_EQ(GsdReader(read_file(target_)).frames(), 1U);
}

// Simulates a full disk, except for the error number.
TEST_F(Growing, KeepsWhatCouldNotBeWritten) {
  GrowingFile file(path_);
  file.go_on(frames_);
  add_frame(frames_, 4);
  const std::string pending = frames_.pending();
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto ignored = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{frames_.written() + 10, before.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  EXPECT_THROW(file.take(frames_), std::system_error);
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &before), 0);
  std::signal(SIGXFSZ, ignored);
  EXPECT_EQ(frames_.pending(), pending);
  file.take(frames_);
  file.finish(frames_, target_);
  EXPECT_EQ(GsdReader(read_file(target_)).get<double>(3, "values"), std::vector<double>(100, 4));
}

}  // namespace
}  // namespace peclet::engine
