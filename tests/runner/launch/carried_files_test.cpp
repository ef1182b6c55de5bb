// Files in pieces between the two ends of a launched worker, and the lies that a far end may tell.
#include "runner/launch/carried_files.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>

#include "runner/store/campaign_directory.h"
#include "tests/runner/runner_fixture.h"

namespace peclet::runner {
namespace {

struct Pipe {
  Pipe() {
    std::array<int, 2> both{};
    if (::pipe(both.data()) != 0) throw std::runtime_error("pipe");
    ends.emplace_back(both[0]);
    ends.emplace_back(both[1]);
  }
  std::vector<Descriptor> ends;
};

// Two links, each of which hears what the other sends.
struct Linked {
  Pipe there, back;
  FrameLink near{std::move(back.ends[0]), std::move(there.ends[1]), largest_answer},
      far{std::move(there.ends[0]), std::move(back.ends[1]), largest_answer};
};

class CarriedFiles : public testing::Test {
 protected:
  CarriedFiles() {
    for (const char* folder : {"from", "to"})
      std::filesystem::create_directories(folder_.path() / folder / "failures");
  }
  CarriedJob job(const char* folder) const {
    const fs::path root = folder_.path() / folder;
    return {root / "spool", root / "checkpoint", root / "failures", (root / "beside@").string()};
  }
  // Sends all of the outbox and takes it in.
  void carry() {
    Linked links;
    const std::array both{&links.near, &links.far};
    for (int idle = 0; idle < 2;) {
      outbox_.fill(links.far);
      FrameLink::exchange(both, -1, std::chrono::milliseconds(0));
      idle = outbox_.is_empty() && links.far.unsent() == 0 ? idle + 1 : 0;
      while (const std::optional<Json> frame = links.near.next()) {
        idle = 0;
        if (frame->at("type") == "piece") {
          ++pieces_;
          inbox_.take(checked_relay_frame(*frame), job("to").path(*frame));
        } else {
          frames_.push_back(*frame);
        }
      }
    }
  }
  Json piece(const char* role, std::uint64_t offset, const std::string& bytes) const {
    return {{"type", "piece"},       {"job", 7},     {"role", role}, {"name", "x"}, {"offset", offset},
            {"bytes", bytes.size()}, {"data", bytes}};
  }
  Json last_piece(const char* role, std::uint64_t offset, const std::string& bytes,
                  const std::string& all) const {
    Json last = piece(role, offset, bytes);
    last["sha256"] = sha256(all);
    return last;
  }
  bool take(const Json& given) { return inbox_.take(checked_relay_frame(given), job("to").path(given)); }
  std::string why_refused(const Json& given) {
    try {
      take(given);
    } catch (const FrameError& error) {
      return error.what();
    }
    return "";
  }
  std::size_t files() const {
    const fs::recursive_directory_iterator all(folder_.path() / "to");
    return static_cast<std::size_t>(
        std::count_if(begin(all), end(all), [](const auto& entry) { return entry.is_regular_file(); }));
  }

  TemporaryFolder folder_;
  Outbox outbox_;
  Inbox inbox_;
  int pieces_ = 0;
  std::vector<Json> frames_;
};

std::string bytes_of_length(std::size_t length) {
  std::string bytes(length, '\0');
  for (std::size_t i = 0; i < length; ++i) bytes[i] = static_cast<char>(i * 131 >> 3);
  return bytes;
}

TEST_F(CarriedFiles, ArriveWholeBeforeTheFrameThatFollowsThem) {
  const std::string large = bytes_of_length(3'000'001);
  write_durably(job("from").spool, large);
  write_durably(job("from").files + "frames.gsd", "");
  outbox_.add(7, role::beside, "frames.gsd", job("from").files + "frames.gsd");
  outbox_.add(7, role::result, "", job("from").spool);
  outbox_.add(7, role::failure, "absent.state", job("from").failures / "absent.state");
  outbox_.add({{"type", "result"}, {"job", 7}});
  carry();
  EXPECT_EQ(read_file(job("to").spool), large);
  EXPECT_EQ(read_file(job("to").files + "frames.gsd"), "");
  EXPECT_EQ(frames_.size(), 1U);
  EXPECT_EQ(pieces_, 9);  // 3 000 001 bytes in pieces of 384 KiB are 8, and the empty file is one
  EXPECT_EQ(files(), 2U);
}

TEST_F(CarriedFiles, AreReadAsTheyWereWhenTheyWereAdded) {
  write_durably(job("from").spool, "first");
  outbox_.add(7, role::result, "", job("from").spool);
  write_durably(job("from").spool, "second");
  carry();
  EXPECT_EQ(read_file(job("to").spool), "first");
}

TEST_F(CarriedFiles, OfACheckpointGrowByWhatIsNew) {
  const fs::path checkpoint = job("from").checkpoint, grown = growing_beside(job("to").checkpoint);
  write_durably(checkpoint, "1");
  write_durably(growing_beside(checkpoint), "abc");
  std::uint64_t sent = outbox_.add_checkpoint(7, checkpoint);
  carry();
  EXPECT_EQ(read_file(grown), "abc");
  write_durably(checkpoint, "2");
  write_durably(growing_beside(checkpoint), "abcdefg");
  sent = outbox_.add_checkpoint(7, checkpoint, sent);
  EXPECT_EQ(sent, 7U);
  carry();
  EXPECT_EQ(read_file(grown), "abcdefg");
  EXPECT_EQ(read_file(job("to").checkpoint), "2");
  // The engine began anew: the file is shorter and another one.
  write_durably(growing_beside(checkpoint), "xy");
  EXPECT_EQ(outbox_.add_checkpoint(7, checkpoint, sent), 2U);
  carry();
  EXPECT_EQ(read_file(grown), "xy");
}

TEST_F(CarriedFiles, WithFaultsAreRefused) {
  EXPECT_NE(why_refused(piece("result", 5, "abc")).find("does not begin at byte 0"), std::string::npos);
  EXPECT_NE(why_refused(piece("growing", 5, "abc")).find("continues a file that is not there"),
            std::string::npos);
  EXPECT_FALSE(take(piece("result", 0, "abc")));
  EXPECT_NE(why_refused(piece("result", 0, "abc")).find("begins at byte 0 instead of 3"), std::string::npos);
  EXPECT_NE(why_refused(piece("result", 9, "abc")).find("begins at byte 9 instead of 3"), std::string::npos);
  EXPECT_NE(why_refused(piece("checkpoint", 0, "abc")).find("before the file before it has ended"),
            std::string::npos);
  EXPECT_NE(why_refused(last_piece("result", 3, "d", "abcx")).find("does not have its hash"),
            std::string::npos);
  for (const char* name : {"../x", "a/b", "..", ".hidden", "-option", "x.tmp", ""}) {
    Json named = piece("failure", 0, "abc");
    named["name"] = name;
    EXPECT_NE(why_refused(named).find("a name that is not plain"), std::string::npos) << name;
  }
  EXPECT_NE(why_refused(piece("home", 0, "abc")).find("/role"), std::string::npos);
}

TEST_F(CarriedFiles, LeaveNothingWhenTheyAreBrokenOff) {
  {
    Inbox inbox;
    inbox.take(piece("result", 0, "abc"), job("to").spool);
    EXPECT_EQ(files(), 1U);
  }
  EXPECT_EQ(files(), 0U);
}

TEST(FrameLinks, CarryAnyBytesBehindTheirFrame) {
  Linked links;
  const std::array both{&links.near, &links.far};
  const std::string bytes = std::string(3, '\0') + "PCF1\n\n\xff" + std::string(100'000, '\n');
  links.far.send({{"type", "piece"}, {"data", bytes}});
  links.far.send({{"type", "piece"}, {"data", ""}});
  links.far.send({{"type", "alive"}});
  std::vector<Json> heard;
  for (int turn = 0; turn < 9; ++turn) {
    FrameLink::exchange(both, -1, std::chrono::milliseconds(0));
    while (const std::optional<Json> frame = links.near.next()) heard.push_back(*frame);
  }
  ASSERT_EQ(heard.size(), 3U);
  EXPECT_EQ(heard[0].at("data"), bytes);
  EXPECT_EQ(heard[1].at("data"), "");
  EXPECT_EQ(heard[2].at("type"), "alive");
}

TEST(FrameLinks, RefusePiecesWithoutASizeOrThatAreTooLong) {
  for (const Json& size : {Json(largest_piece + 1), Json(-1), Json("3"), Json()}) {
    Pipe there, back;
    const std::string frame = encode_frame({{"type", "piece"}, {"bytes", size}});
    ASSERT_EQ(::write(there.ends[1].number(), frame.data(), frame.size()), std::ssize(frame));
    FrameLink link(std::move(there.ends[0]), std::move(back.ends[1]), largest_answer);
    const std::array one{&link};
    FrameLink::exchange(one, -1, std::chrono::milliseconds(0));
    EXPECT_THROW(link.next(), FrameError) << size;
  }
}

TEST(FrameLinks, LeaveOutWhatAMachinePrintsFirst) {
  Pipe there, back;
  const std::string greeting = "Welcome to node7!\nPCF is not PCF";
  ASSERT_EQ(::write(there.ends[1].number(), greeting.data(), greeting.size()), std::ssize(greeting));
  const std::string frame = encode_frame({{"type", "ready"}});
  ASSERT_EQ(::write(there.ends[1].number(), frame.data(), frame.size()), std::ssize(frame));
  FrameLink link(std::move(there.ends[0]), std::move(back.ends[1]), largest_answer, 100);
  const std::array one{&link};
  FrameLink::exchange(one, -1, std::chrono::milliseconds(0));
  const std::optional<Json> heard = link.next();
  ASSERT_TRUE(heard);
  EXPECT_EQ(heard->at("type"), "ready");
}

TEST(FrameLinks, RefuseAMachineThatOnlyPrints) {
  Pipe there, back;
  const std::string greeting(101, 'x');
  ASSERT_EQ(::write(there.ends[1].number(), greeting.data(), greeting.size()), std::ssize(greeting));
  FrameLink link(std::move(there.ends[0]), std::move(back.ends[1]), largest_answer, 100);
  const std::array one{&link};
  EXPECT_THROW(FrameLink::exchange(one, -1, std::chrono::milliseconds(0)), FrameError);
}

}  // namespace
}  // namespace peclet::runner
