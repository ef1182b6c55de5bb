#include "contract/durable_file.h"

#include <gtest/gtest.h>

#include <thread>

#include "contract/sha256.h"
#include "tests/contract/refusal.h"
#include "tests/contract/temporary_folder.h"

namespace peclet {
namespace {

namespace fs = std::filesystem;

using DurableFile = FolderOfTest;

TEST_F(DurableFile, ReadsBackWhatWasWrittenAndLeavesNothingElse) {
  const std::string bytes("a\0b\n\xff", 5);
  write_durably(folder() / "f", bytes);
  EXPECT_EQ(read_file(folder() / "f"), bytes);
  write_durably(folder() / "f", "");
  EXPECT_EQ(read_file(folder() / "f"), "");
  EXPECT_EQ(entries(), 1U);
}

TEST_F(DurableFile, AFailureNamesThePathAndLeavesTheOldContent) {
  const fs::path path = folder() / "absent" / "f";
  EXPECT_EQ(refusal_by<std::system_error>([&] { write_durably(path, "x"); }),
            "cannot create " + path.string() + ": No such file or directory");
  fs::create_directory(folder() / "d");  // a folder cannot be replaced by a file
  EXPECT_THROW(write_durably(folder() / "d", "x"), std::system_error);
  EXPECT_TRUE(fs::is_directory(folder() / "d"));
  EXPECT_EQ(entries(), 1U);
  EXPECT_THROW(read_file(folder() / "d"), std::system_error);
  EXPECT_THROW(read_file(folder() / "f"), std::system_error);
}

TEST_F(DurableFile, ManyWritersOfOneFileNeverMixTheirBytes) {
  std::vector<std::thread> writers;
  for (char letter = 'a'; letter < 'e'; ++letter) {
    writers.emplace_back([this, letter] {
      for (int i = 0; i < 20; ++i) write_durably(folder() / "f", std::string(10000, letter));
    });
  }
  for (std::thread& writer : writers) writer.join();
  const std::string bytes = read_file(folder() / "f");
  EXPECT_EQ(bytes, std::string(10000, bytes.at(0)));
  EXPECT_EQ(entries(), 1U);
}

// Expected digests: FIPS 180-2, appendix B.1 and B.3.
TEST_F(DurableFile, Sha256IsThePublishedOne) {
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256_base64("abc"), "ungWv48Bz+pBQUDeXa4iI7ADYaOWF3qctBD/YfIAFa0=");
  write_durably(folder() / "f", std::string(1'000'000, 'a'));
  EXPECT_EQ(sha256_of_file(folder() / "f"),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
  EXPECT_THROW(sha256_of_file(folder() / "g"), std::system_error);
}

TEST_F(DurableFile, FoldersAreMadeWithThoseAboveThem) {
  create_folders_durably(folder() / "a" / "b" / "c");
  EXPECT_TRUE(fs::is_directory(folder() / "a" / "b" / "c"));
  create_folders_durably(folder() / "a" / "b" / "c");
  write_durably(folder() / "f", "x");
  EXPECT_THROW(create_folders_durably(folder() / "f" / "g"), std::system_error);
}

}  // namespace
}  // namespace peclet
