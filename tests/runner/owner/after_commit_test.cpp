// What is to happen after a commit happens once, whatever was in the way.
#include "runner/owner/after_commit.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>
#include <vector>

#include "tests/runner/runner_fixture.h"

namespace peclet::runner {
namespace {

namespace fs = std::filesystem;

// A checkpoint below a file cannot be removed. Then the folder is there as it was, with the checkpoint in it.
TEST(AfterCommit, WhatACommitHasLeftToDoOutlivesATransactionThatFails) {
  const TemporaryFolder folder;
  const fs::path checkpoints = folder.path() / "checkpoints", checkpoint = checkpoints / "a.checkpoint";
  std::ofstream(checkpoints) << "no folder";
  SilentListener listener;
  AfterCommit after;
  after.discard(checkpoint);
  after.note("of the commit");
  EXPECT_THROW(after.carry_out(listener), std::system_error);
  EXPECT_TRUE(listener.notes.empty());
  after.discard(folder.path() / "of a seed that goes on");
  after.note("of a transaction that failed");
  after.forget();
  fs::remove(checkpoints);
  fs::create_directory(checkpoints);
  for (const fs::path& file : {checkpoint, folder.path() / "of a seed that goes on"})
    std::ofstream(file) << 1;
  after.carry_out(listener);
  EXPECT_FALSE(fs::exists(checkpoint));
  EXPECT_TRUE(fs::exists(folder.path() / "of a seed that goes on"));
  EXPECT_EQ(listener.notes, std::vector<std::string>{"of the commit"});
  after.carry_out(listener);
  EXPECT_EQ(listener.notes.size(), 1U);
}

}  // namespace
}  // namespace peclet::runner
