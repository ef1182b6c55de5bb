#include "engine/realisation/checkpoint.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cmath>

#include "contract/durable_file.h"
#include "contract/sha256.h"
#include "tests/engine/realisation/small_result.h"
#include "tests/engine/temporary_folder.h"

namespace peclet::engine {
namespace {

const CheckpointIdentity identity = {"a scene", 7, "a binary"};

class Checkpoint : public testing::Test {
 protected:
  Checkpoint() {
    simulation_.start();
    simulation_.advance(30);
    write_checkpoint(path_, identity, {}, simulation_);
    whole_ = read_file(path_);
  }

  // Returns the refusal of a file, which must name it.
  std::string refusal_of(const std::filesystem::path& path,
                         const CheckpointIdentity& expected = identity) const {
    Simulation fresh = simulation_of(scene_, 7);
    const std::string message = refusal_by<CheckpointError>([&] { read_checkpoint(path, expected, fresh); });
    EXPECT_TRUE(message.empty() || contains(message, path.string()));
    return message;
  }
  // Returns the refusal of a file with these bytes, which must leave it unchanged.
  std::string refusal(const std::string& bytes, const CheckpointIdentity& expected = identity) const {
    write_durably(path_, bytes);
    const std::string message = refusal_of(path_, expected);
    EXPECT_TRUE(read_file(path_) == bytes);
    return message;
  }

  void expect_refused(const std::string& bytes, const std::string& reason) {
    EXPECT_TRUE(contains(refusal(bytes), reason));
  }

  // Returns the file with another payload, with matching length and checksum.
  std::string with_payload(const std::string& payload) const {
    ArchiveWriter length;
    length.put(static_cast<std::uint64_t>(payload.size()));
    return whole_.substr(0, 12) + length.bytes() + payload + sha256(payload);
  }
  std::string payload() const { return whole_.substr(20, whole_.size() - 20 - 64); }

  TemporaryFolder folder_;
  std::filesystem::path path_ = folder_ / "checkpoint";
  Scene scene_ = read_scene(small_scene(), "");
  Simulation simulation_{scene_, make_schedule(scene_, ""), 7, 1, ""};
  std::string whole_;
};

TEST_F(Checkpoint, IsAcceptedAsItWasWritten) {
  EXPECT_EQ(refusal(whole_), "");
  EXPECT_EQ(refusal(with_payload(payload())), "");
}

TEST_F(Checkpoint, WhatIsNoCheckpointIsSaidToBeNone) {
  expect_refused("", "is no checkpoint");
  expect_refused("PCLTCKPT", "is no checkpoint");
  expect_refused(std::string(5000, 'x'), "is no checkpoint");
  std::string other = whole_;
  other[3] = 'X';
  expect_refused(other, "is no checkpoint");
}

// Links are not followed, pipes not waited for, and oversized files not read.
TEST_F(Checkpoint, WhatIsNoFileOfReasonableSizeIsRefused) {
  std::filesystem::create_symlink(path_, folder_ / "link");
  EXPECT_TRUE(contains(refusal_of(folder_ / "link"), "is a link"));
  ASSERT_EQ(mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  EXPECT_TRUE(contains(refusal_of(folder_ / "pipe"), "is a FIFO"));
  std::filesystem::resize_file(path_, std::uintmax_t{1} << 40);
  EXPECT_TRUE(contains(refusal_of(path_), "is too large"));
}

TEST_F(Checkpoint, OtherVersionsAreRefused) {
  std::string other = whole_;
  other[8] = 99;
  expect_refused(other, "version 99");
}

TEST_F(Checkpoint, TornFilesAreRefused) {
  for (const std::size_t kept :
       {std::size_t{84}, std::size_t{200}, whole_.size() / 2, whole_.size() - 64, whole_.size() - 1}) {
    expect_refused(whole_.substr(0, kept), "is torn");
  }
  expect_refused(whole_ + "x", "is torn");
}

TEST_F(Checkpoint, AnyFlippedBitOfThePayloadIsNoticed) {
  for (const std::size_t place : {std::size_t{20}, std::size_t{60}, whole_.size() / 2, whole_.size() - 65}) {
    std::string damaged = whole_;
    damaged[place] = static_cast<char>(damaged[place] ^ 1);
    expect_refused(damaged, "is damaged");
  }
  std::string damaged = whole_;
  damaged.back() = damaged.back() == '0' ? '1' : '0';  // changes the checksum
  expect_refused(damaged, "is damaged");
}

// The payloads are intact but have the wrong length.
TEST_F(Checkpoint, PayloadsOfTheWrongLengthAreRefused) {
  expect_refused(with_payload(payload() + "x"), "unexpected bytes at its end");
  expect_refused(with_payload(payload().substr(0, payload().size() - 8)), "ends too early");
  expect_refused(with_payload(""), "ends too early");
}

// Positions or cells that are not finite would become indices of the neighbour grid.
TEST_F(Checkpoint, PayloadsWithoutPlacesAreRefused) {
  const auto bytes_of = [](const auto& value) {
    ArchiveWriter writer;
    writer.put(value);
    return writer.bytes();
  };
  const Vector3 place = simulation_.system().particles.position[5];
  const Matrix3 gradient = simulation_.system().box.displacement_gradient();
  for (const double bad : {std::nan(""), HUGE_VAL, 1e300, 1e9}) {
    std::string bytes = payload();
    const std::string known = bytes_of(place);
    bytes.replace(bytes.find(known), known.size(), bytes_of(Vector3{place.x, bad, place.z}));
    expect_refused(with_payload(bytes), "a sphere far outside its cell");
    bytes = payload();
    const std::string cell = bytes_of(gradient);
    bytes.replace(bytes.find(cell), cell.size(),
                  bytes_of(Matrix3{Vector3{-1, 0, 0}, Vector3{bad, 0, 0}, Vector3{}}));
    expect_refused(with_payload(bytes), "has a cell that has no volume");
  }
  // A flat cell, and one tilted by a hundred edges: in both, a hundred images are near.
  for (const Matrix3& thin : {Matrix3{Vector3{}, Vector3{0, -0.99, 0}, Vector3{}},
                              Matrix3{Vector3{}, Vector3{100, 0, 0}, Vector3{}}}) {
    std::string bytes = payload();
    const std::string cell = bytes_of(gradient);
    bytes.replace(bytes.find(cell), cell.size(), bytes_of(thin));
    expect_refused(with_payload(bytes), "too thin for its spheres");
  }
}

TEST_F(Checkpoint, OfAnotherRealisationIsRefusedWithWhatDiffers) {
  EXPECT_TRUE(contains(refusal(whole_, {"another", 7, "a binary"}), "another scene"));
  EXPECT_TRUE(contains(refusal(whole_, {"a scene", 8, "a binary"}), "another seed"));
  EXPECT_TRUE(contains(refusal(whole_, {"a scene", 7, "another"}), "another build"));
}

TEST_F(Checkpoint, AnAbsentFileIsAnErrorThatNamesIt) {
  EXPECT_TRUE(contains(refusal_of(folder_ / "absent"), "absent"));
}

JobSpecification job_with(const std::filesystem::path& checkpoint) {
  JobSpecification job = job_of(small_scene(), "", 7);
  job.checkpoint = checkpoint;
  return job;
}

TEST_F(Checkpoint, AJobEndsWithAnUnusableOneUnlessItMayStartAgain) {
  write_durably(path_, whole_);  // has the hash of another scene
  JobSpecification job = job_with(path_);
  EXPECT_THROW(run_job(job, {}), CheckpointError);
  EXPECT_TRUE(read_file(path_) == whole_);

  job.restart_on_bad_checkpoint = true;
  JobEvents events;
  std::string remark;
  events.remark = [&](const std::string& text) { remark = text; };
  Json result = run_job(job, events).value();
  EXPECT_TRUE(contains(remark, "another scene"));
  EXPECT_TRUE(read_file(folder_ / "checkpoint.rejected") == whole_);
  EXPECT_EQ(result.at("final_state_sha256"), run_job(job_with({}), {}).value().at("final_state_sha256"));
}

}  // namespace
}  // namespace peclet::engine
