#include "contract/frames.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <system_error>
#include <thread>

namespace peclet {
namespace {

using std::chrono::milliseconds;

struct SocketPair {
  SocketPair() { EXPECT_EQ(::socketpair(AF_UNIX, SOCK_STREAM, 0, ends.data()), 0); }
  ~SocketPair() {
    for (const int end : ends) ::close(end);
  }
  std::array<int, 2> ends{};
};

FrameDecoder fed(const std::string& bytes) {
  FrameDecoder decoder;
  decoder.feed(bytes.data(), bytes.size());
  return decoder;
}

TEST(Frames, HeaderIsMagicAndLittleEndianLength) {
  const std::string frame = encode_frame({{"type", "stop"}});
  EXPECT_EQ(frame, std::string("PCF1\x10\0\0\0", 8) + "{\"type\":\"stop\"}\n");
}

TEST(Frames, ArriveWholeHoweverTheyAreCut) {
  const std::string bytes = encode_frame({{"type", "a"}, {"n", 1}}) + encode_frame({{"type", "b"}});
  for (std::size_t cut = 0; cut <= bytes.size(); ++cut) {
    FrameDecoder decoder;
    std::vector<Json> messages;
    const auto drain = [&] {
      while (auto message = decoder.next()) messages.push_back(*message);
    };
    decoder.feed(bytes.data(), cut);
    drain();
    decoder.feed(bytes.data() + cut, bytes.size() - cut);
    drain();
    ASSERT_EQ(messages.size(), 2U) << cut;
    EXPECT_EQ(messages[0], (Json{{"type", "a"}, {"n", 1}}));
    EXPECT_EQ(messages[1]["type"], "b");
    EXPECT_TRUE(decoder.empty());
  }
}

TEST(Frames, WhatIsNoFrameIsRefused) {
  const auto framed = [](const std::string& payload) {
    return std::string("PCF1") + static_cast<char>(payload.size()) + std::string(3, '\0') + payload;
  };
  const std::string faults[] = {"Segmentation fault\n",
                                "H",
                                std::string("PCF2\0\0\0\0", 8),
                                std::string("PCF1\x01\0\0\x04", 8),  // one byte more than 64 MiB
                                framed("{\"type\":"),
                                framed("[1]"),
                                framed("{\"job\":1}"),
                                framed("{\"type\":1}"),
                                framed("{\"type\":\"a\",\"type\":\"b\"}"),
                                framed("")};
  for (const std::string& fault : faults) EXPECT_THROW(fed(fault).next(), FrameError) << fault;
}

TEST(Frames, WhatIsNoMessageIsNotSent) {
  EXPECT_THROW(encode_frame(Json::array()), FrameError);
  EXPECT_THROW(encode_frame({{"job", 1}}), FrameError);
  EXPECT_THROW(encode_frame({{"type", "log"}, {"text", std::string(largest_frame, 'x')}}), FrameError);
}

TEST(FrameChannel, CarriesMoreThanTheSocketHolds) {
  const SocketPair pair;
  const Json sent = {{"type", "result"}, {"text", std::string(5'000'000, 'x')}};
  std::thread sender([&] { FrameChannel(pair.ends[0]).send(sent); });
  FrameChannel receiver(pair.ends[1]);
  Json received;
  EXPECT_EQ(receiver.receive(received, milliseconds(-1)), FrameChannel::Status::message);
  sender.join();
  EXPECT_EQ(received, sent);
}

TEST(FrameChannel, SilenceAndAClosedPeerAreToldApart) {
  SocketPair pair;
  FrameChannel channel(pair.ends[0]);
  Json message;
  EXPECT_EQ(channel.receive(message, milliseconds(0)), FrameChannel::Status::nothing);
  EXPECT_EQ(channel.receive(message, milliseconds(20)), FrameChannel::Status::nothing);
  FrameChannel(pair.ends[1]).send({{"type", "stop"}});
  ::shutdown(pair.ends[1], SHUT_RDWR);
  EXPECT_EQ(channel.receive(message, milliseconds(-1)), FrameChannel::Status::message);
  EXPECT_EQ(message["type"], "stop");
  EXPECT_EQ(channel.receive(message, milliseconds(-1)), FrameChannel::Status::closed);
}

// A raised signal would end the test with SIGPIPE.
TEST(FrameChannel, SendingToAClosedPeerIsAnErrorAndNoSignal) {
  const auto error_of = [](int descriptor) {
    try {
      FrameChannel(descriptor).send({{"type", "progress"}});
    } catch (const std::system_error& error) {
      return error.code().value();
    }
    return 0;
  };
  const SocketPair pair;
  ::shutdown(pair.ends[1], SHUT_RDWR);
  EXPECT_EQ(error_of(pair.ends[0]), EPIPE);

  std::array<int, 2> pipe_ends{};
  ASSERT_EQ(::pipe(pipe_ends.data()), 0);
  ::close(pipe_ends[0]);
  EXPECT_EQ(error_of(pipe_ends[1]), EPIPE);
  ::close(pipe_ends[1]);
}

}  // namespace
}  // namespace peclet
