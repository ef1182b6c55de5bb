#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include <thread>

#include "contract/durable_file.h"
#include "contract/named_files.h"
#include "tests/contract/refusal.h"
#include "tests/contract/temporary_folder.h"

namespace peclet {
namespace {

namespace fs = std::filesystem;

using OutputFile = FolderOfTest;

std::string refusal(const fs::path& path) {
  return refusal_by([&] { write_output(path, "x"); });
}

TEST_F(OutputFile, AFileIsReplacedWhole) {
  const fs::path file = folder() / "f";
  write_output(file, "one");
  write_output(file, "2");
  EXPECT_EQ(read_file(file), "2");
  EXPECT_EQ(entries(), 1U);
}

TEST_F(OutputFile, ALinkIsFollowedAndStays) {
  fs::create_directory(folder() / "d");
  write_durably(folder() / "d" / "target", "old");
  fs::create_symlink("d/target", folder() / "link");
  fs::create_symlink("link", folder() / "chain");
  write_output(folder() / "chain", "new");
  EXPECT_EQ(read_file(folder() / "d" / "target"), "new");
  EXPECT_TRUE(fs::is_symlink(folder() / "link"));
  EXPECT_TRUE(fs::is_symlink(folder() / "chain"));
  fs::create_symlink("d/absent", folder() / "ahead");
  write_output(folder() / "ahead", "made");
  EXPECT_EQ(read_file(folder() / "d" / "absent"), "made");
  EXPECT_TRUE(fs::is_symlink(folder() / "ahead"));
}

// Output in pieces replaces a file completely or not at all.
TEST_F(OutputFile, TakesPiecesThatNeedNotFitIntoMemory) {
  const fs::path file = folder() / "f";
  write_output(file, "old");
  int left = 3;
  write_output(file, [&] { return left-- > 0 ? std::string("piece ") : std::string(); });
  EXPECT_EQ(read_file(file), "piece piece piece ");
  left = 2;
  const auto fails = [&]() -> std::string {
    if (left-- > 0) return "new";
    throw InputError("the third", "", "", "is wrong");
  };
  EXPECT_THROW(write_output(file, fails), InputError);
  EXPECT_EQ(read_file(file), "piece piece piece ");
  EXPECT_EQ(entries(), 1U);
  fs::create_symlink(file, folder() / "link");
  left = 1;
  write_output(folder() / "link", [&] { return left-- > 0 ? std::string("x") : std::string(); });
  EXPECT_TRUE(fs::is_symlink(folder() / "link"));
  EXPECT_EQ(read_file(file), "x");
}

TEST_F(OutputFile, AFifoIsWrittenToAndStays) {
  const fs::path pipe = folder() / "fifo";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  std::string read;
  std::thread reader([&] { read = read_file(pipe); });
  write_output(pipe, "through");
  reader.join();
  EXPECT_EQ(read, "through");
  EXPECT_TRUE(fs::is_fifo(pipe));
}

// Root could damage a device, so it gets one of the test's own: 1, 3 is /dev/null (devices.txt).
TEST_F(OutputFile, ADeviceIsWrittenToAndStays) {
  fs::path device = "/dev/null";
  if (geteuid() == 0) {
    device = folder() / "null";
    ASSERT_EQ(mknod(device.c_str(), S_IFCHR | 0600, makedev(1, 3)), 0);
  }
  fs::create_symlink(device, folder() / "link");
  write_output(device, "x");
  write_output(folder() / "link", "x");
  EXPECT_TRUE(fs::is_character_file(device));
  EXPECT_TRUE(fs::is_symlink(folder() / "link"));
  EXPECT_EQ(entries(), geteuid() == 0 ? 2U : 1U);
}

// The case of `{ echo before; peclet export --output /dev/stdout; echo after; } > file`.
TEST_F(OutputFile, ADescriptorOfTheProcessIsUsedAsItIs) {
  const fs::path file = folder() / "f";
  const Descriptor open = open_file(file, O_WRONLY | O_CREAT);
  write_all(open.number(), "before ", file);
  write_output("/dev/fd/" + std::to_string(open.number()), "it ");
  write_output("/proc/self/fd/" + std::to_string(open.number()), "twice ");
  write_all(open.number(), "after", file);
  EXPECT_EQ(read_file(file), "before it twice after");
  EXPECT_EQ(entries(), 1U);
  const Descriptor reading = open_file(file, O_RDONLY);
  EXPECT_NE(refusal("/dev/fd/" + std::to_string(reading.number())), "");
  EXPECT_NE(refusal("/dev/fd/987654"), "");
}

TEST_F(OutputFile, WhatCannotBeWrittenIsRefusedAndNothingIsMade) {
  EXPECT_TRUE(contains(refusal(folder()), folder().string() + ": is a folder"));
  EXPECT_TRUE(contains(refusal(folder() / ""), "folder"));
  EXPECT_TRUE(contains(refusal(folder() / "absent" / "f"), "absent is not there"));
  fs::create_symlink("loop", folder() / "loop");
  EXPECT_TRUE(contains(refusal(folder() / "loop"), "symbolic links"));
  EXPECT_TRUE(contains(refusal(folder() / std::string(300, 'n')), "too long"));
  EXPECT_EQ(entries(), 1U);
  EXPECT_THROW(check_output(folder()), InputError);
  check_output(folder() / "f");
  EXPECT_EQ(entries(), 1U);
}

}  // namespace
}  // namespace peclet
