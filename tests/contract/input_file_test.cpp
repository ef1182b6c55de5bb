#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>
#include <thread>

#include "contract/named_files.h"
#include "tests/contract/refusal.h"
#include "tests/contract/temporary_folder.h"

namespace peclet {
namespace {

namespace fs = std::filesystem;

constexpr InputLimits small{std::size_t{1} << 20, 1000};

class InputFile : public FolderOfTest {
 protected:
  fs::path file(const std::string& content) {
    const fs::path path = folder() / "input.json";
    std::ofstream(path) << content;
    return path;
  }
  static std::string fault_of(const fs::path& path) {
    return refusal_by([&] { read_json_input(path, small); });
  }
};

TEST_F(InputFile, OfTheLargestSizeIsRead) {
  const std::string text = "[" + std::string((1U << 20U) - 2, ' ') + "]";
  EXPECT_EQ(read_input(file(text), small), text);
  EXPECT_EQ(fault_of(file(text)), "");
}

TEST_F(InputFile, ThatIsTooLargeIsRefusedBeforeItIsRead) {
  const fs::path path = file("[]");
  fs::resize_file(path, std::uintmax_t{1} << 40U);  // a sparse terabyte
  EXPECT_EQ(fault_of(path), path.string() + ": 1048576 MiB: must be at most 1 MiB");
}

TEST_F(InputFile, APipeIsReadToItsEnd) {
  const fs::path path = folder() / "pipe";
  ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
  std::thread writer([&] { std::ofstream(path) << "[1, 2]"; });
  EXPECT_EQ(read_json_input(path, small), Json::parse("[1, 2]"));
  writer.join();
}

TEST_F(InputFile, ADeviceThatNeverEndsIsRefused) {
  EXPECT_EQ(fault_of("/dev/zero"), "/dev/zero: more than 1 MiB: must be at most 1 MiB");
}

TEST_F(InputFile, WhatCannotBeReadIsNamedWithTheReason) {
  const fs::path loop = folder() / "loop";
  fs::create_symlink(loop, loop);
  EXPECT_EQ(fault_of(loop), loop.string() + ": cannot be read: Too many levels of symbolic links");
  EXPECT_EQ(fault_of(folder()), folder().string() + ": cannot be read: Is a directory");
  EXPECT_TRUE(contains(fault_of(std::string(5000, 'n')), "File name too long"));
  EXPECT_EQ(fault_of("/nonexistent/a"), "/nonexistent/a: cannot be read: No such file or directory");
}

TEST_F(InputFile, OfTooManyValuesIsRefusedWithTheirPlace) {
  std::string numbers = "[0";
  for (int i = 1; i < 999; ++i) numbers += ",0";  // a thousand values with the array
  EXPECT_EQ(fault_of(file(numbers + "]")), "");
  EXPECT_TRUE(contains(fault_of(file(numbers + ",\n\"\"]")), "line 2, column 2: more than 1000 values"));
}

TEST_F(InputFile, NothingMayFollowTheDocumentNotEvenBehindANul) {
  const std::string rubbish = std::string("{}\n\0 rubbish", 12);
  EXPECT_TRUE(contains(fault_of(file(rubbish)), "line 2, column 1: a NUL character"));
  EXPECT_TRUE(contains(fault_of(file(std::string("[1]\0", 4))), "a NUL character"));
}

}  // namespace
}  // namespace peclet
