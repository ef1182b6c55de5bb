// Trajectories from any source: valid files are read, others are refused with one sentence.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "contract/durable_file.h"
#include "engine/snapshots/gsd_file.h"
#include "tests/contract/refusal.h"
#include "tests/engine/snapshots/gsd_reader.h"
#include "tests/engine/temporary_folder.h"

namespace peclet::engine::gsd {
namespace {

class GsdFile : public testing::Test {
 protected:
  GsdFile() {
    Frames frames;
    for (std::uint64_t step = 10; step < 13; ++step) {
      frames.add_single<std::uint64_t>("configuration/step", step);
      if (step != 11)
        frames.add("particles/position", std::vector<float>{1, 2, 3, 4, 5, static_cast<float>(step)}, 3);
      frames.end_frame();
    }
    whole_ = frames.head() + frames.pending() + frames.tail();
  }

  // Returns the refusal, or nothing if the file was read with every chunk of its index.
  std::string refusal(const std::string& bytes) const {
    write_durably(path_, bytes);
    const std::string message = refusal_by([&] {
      const Reader reader(path_);
      for (std::uint64_t frame = 0; frame < reader.frames(); ++frame) {
        if (const IndexEntry* found = reader.find(frame, "configuration/step"))
          reader.get<std::uint64_t>(*found);
        if (const IndexEntry* found = reader.find(frame, "particles/position")) reader.get<float>(*found, 3);
      }
    });
    EXPECT_TRUE(message.empty() || message.starts_with(path_.string() + ": ")) << message;
    return message;
  }

  template <class Value>
  std::string with(std::size_t place, Value value) const {
    std::string bytes = whole_;
    std::memcpy(bytes.data() + place, &value, sizeof value);
    return bytes;
  }

  TemporaryFolder folder_;
  std::filesystem::path path_ = folder_ / "t.gsd";
  std::string whole_;
};

TEST_F(GsdFile, IsReadAsItWasWritten) {
  EXPECT_EQ(refusal(whole_), "");
  const Reader reader(path_);
  EXPECT_EQ(reader.frames(), 3U);
  EXPECT_EQ(reader.find(1, "particles/position"), nullptr);
  EXPECT_EQ(reader.find(3, "configuration/step"), nullptr);
  EXPECT_EQ(reader.find(0, "particles/positio"), nullptr);
  EXPECT_EQ(reader.get<float>(*reader.find(2, "particles/position"), 3),
            (std::vector<float>{1, 2, 3, 4, 5, 12}));
  EXPECT_EQ(reader.get<std::uint64_t>(*reader.find(1, "configuration/step")), std::vector<std::uint64_t>{11});
  EXPECT_THROW(reader.get<double>(*reader.find(2, "particles/position"), 3), InputError);
  EXPECT_THROW(reader.get<float>(*reader.find(2, "particles/position"), 6), InputError);
}

// The published positions of the header's numbers.
TEST_F(GsdFile, OfNoSuchKindIsRefusedWithWhatItIs) {
  EXPECT_TRUE(contains(refusal(""), "0 bytes"));
  EXPECT_TRUE(contains(refusal(std::string(4096, 'x')), "begins with 0x7878787878787878"));
  EXPECT_TRUE(contains(refusal(with(44, version(1, 0))), "layout 1.0"));
  EXPECT_TRUE(contains(refusal(with(44, version(3, 0))), "layout 3.0"));
  EXPECT_EQ(refusal(with(44, version(2, 7))), "");
  EXPECT_TRUE(contains(refusal(with(112, 'H')), "schema Hoomd 1"));
  EXPECT_TRUE(contains(refusal(with(40, version(2, 0))), "schema hoomd 2"));
}

TEST_F(GsdFile, WithANameTwiceIsRefused) {
  std::string bytes = whole_;
  const std::string name = "particles/position";
  bytes.replace(bytes.find(name), name.size() + 1, std::string("configuration/step") + '\0');
  EXPECT_TRUE(contains(refusal(bytes), "configuration/step: must be in the list of names once"));
}

// No memory is allocated for these counts, which exceed the machine's.
TEST_F(GsdFile, OfCountsBeyondItsLengthIsRefused) {
  const auto index = value_at<std::uint64_t>(whole_, 8);
  for (const std::uint64_t huge : {std::uint64_t{1} << 20, std::uint64_t{1} << 40, ~std::uint64_t{0}}) {
    EXPECT_TRUE(contains(refusal(with(8, huge)), "of the index"));
    EXPECT_TRUE(contains(refusal(with(16, huge)), "of the index"));
    EXPECT_TRUE(contains(refusal(with(24, huge)), "segments of names"));
    EXPECT_TRUE(contains(refusal(with(32, huge)), "segments of names"));
    EXPECT_TRUE(contains(refusal(with(index + 8, huge)), "configuration/step of frame 0"));
    EXPECT_TRUE(contains(refusal(with(index + 32, huge)), "entry 1 of the index: is out of order"));
  }
  EXPECT_NE(refusal(with(index + 16, std::int64_t{-8})), "");
  EXPECT_NE(refusal(with(index + 24, 0xffffffffU)), "");
  EXPECT_NE(refusal(with(index + 24, 0U)), "");
  EXPECT_TRUE(contains(refusal(with(index + 28, std::uint16_t{9})), "has name 9 of 2"));
  EXPECT_TRUE(contains(refusal(with(index + 30, std::uint8_t{0})), "has type 0"));
  EXPECT_TRUE(contains(refusal(with(index + 30, std::uint8_t{200})), "has type 200"));
}

TEST_F(GsdFile, CutAnywhereIsRefused) {
  for (std::size_t length = 0; length < whole_.size(); length += 7) {
    EXPECT_NE(refusal(whole_.substr(0, length)), "") << length;
  }
  EXPECT_NE(refusal(whole_.substr(0, whole_.size() - 1)), "");
}

// Every file is read or refused; a crash, an endless loop or a bad_alloc would end the test.
TEST_F(GsdFile, WithAnyByteChangedEndsInOneOfTwoWays) {
  std::size_t refused = 0;
  for (std::size_t place = 0; place < whole_.size(); ++place) {
    for (const int mask : {0x01, 0x80, 0xff}) {
      std::string bytes = whole_;
      bytes[place] = static_cast<char>(static_cast<unsigned char>(bytes[place]) ^ mask);
      refused += refusal(bytes).empty() ? 0 : 1;
    }
  }
  EXPECT_GT(refused, 300U);
  EXPECT_LT(refused, 3 * whole_.size());
}

TEST_F(GsdFile, IsARegularOneThatIsThere) {
  EXPECT_THROW(Reader(folder_ / "absent"), InputError);
  EXPECT_THROW(Reader(folder_.path()), InputError);
  ASSERT_EQ(mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  EXPECT_THROW(Reader(folder_ / "pipe"), InputError);
  EXPECT_FALSE(begins_as_gsd(folder_ / "pipe"));
  write_durably(path_, whole_);
  EXPECT_TRUE(begins_as_gsd(path_));
  EXPECT_FALSE(begins_as_gsd(folder_ / "absent"));
  std::filesystem::create_symlink(path_, folder_ / "link");
  EXPECT_EQ(Reader(folder_ / "link").frames(), 3U);
}

}  // namespace
}  // namespace peclet::engine::gsd
