#include "runner/store/campaign_directory.h"

#include <gtest/gtest.h>
#include <sys/syscall.h>
#include <sys/vfs.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>

#include "contract/durable_file.h"
#include "contract/guarded_file.h"
#include "runner/store/locks.h"
#include "tests/runner/runner_fixture.h"

namespace {

unsigned long kind_of_file_system = 0;  // 0 for the kernel's answer

}  // namespace

// Takes the place of the C library's function.
extern "C" int statfs(const char* path, struct statfs* about) noexcept {
  const auto result = static_cast<int>(syscall(SYS_statfs, path, about));
  if (result == 0 && kind_of_file_system != 0)
    about->f_type = static_cast<decltype(about->f_type)>(kind_of_file_system);
  return result;
}

namespace peclet::runner {
namespace {

TEST(CampaignDirectory, LiesBesideTheCampaignUnlessChosen) {
  EXPECT_EQ(campaign_directory("/data/flow.json", "").root(), "/data/flow.peclet");
  EXPECT_EQ(campaign_directory("/data/phi-0.50.json", "").root(), "/data/phi-0.50.peclet");
  EXPECT_EQ(campaign_directory("/data/flow.json", "/elsewhere").root(), "/elsewhere");
}

TEST(CampaignDirectory, AttemptsShareACheckpointAndNeverASpoolFile) {
  const CampaignDirectory directory("/data/flow.peclet");
  const std::string hash(64, 'a'), other(64, 'b');
  EXPECT_NE(directory.spool_file(hash, 3, 1), directory.spool_file(hash, 3, 2));
  EXPECT_NE(directory.checkpoint(hash, 3), directory.checkpoint(hash, 4));
  EXPECT_NE(directory.checkpoint(hash, 3), directory.checkpoint(other, 3));
}

TEST(CampaignDirectory, KnowsWhatGrowsBesideACheckpoint) {
  const std::filesystem::path checkpoint = CampaignDirectory("/data/flow.peclet").checkpoint("a", 3);
  const std::filesystem::path growing = growing_beside(checkpoint);
  EXPECT_EQ(growing, checkpoint.string() + "@growing");
  EXPECT_TRUE(is_growing(growing));
  EXPECT_FALSE(is_growing(checkpoint));
  EXPECT_EQ(checkpoint_of(growing), checkpoint);
  EXPECT_EQ(checkpoint_of(checkpoint), checkpoint);
}

// Magic numbers of linux/magic.h and of the file systems' own sources.
TEST(CampaignDirectory, ALocalFileSystemIsNoNetworkAndOthersAreNamed) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "not" / "there" / "yet";
  kind_of_file_system = 0xef53;  // ext4
  EXPECT_EQ(network_file_system(path), std::nullopt);
  EXPECT_EQ(doubt_about_file_system(path), "");
  kind_of_file_system = 0x6969;
  EXPECT_EQ(network_file_system(path), "NFS");
  kind_of_file_system = 0x65735546;
  EXPECT_EQ(network_file_system(path), std::nullopt);
  EXPECT_TRUE(says(doubt_about_file_system(path), "is on FUSE (sshfs, DAOS, Gluster and others)"));
  kind_of_file_system = 0x01021997;
  EXPECT_TRUE(says(doubt_about_file_system(path), "is on 9P"));
  kind_of_file_system = 0;
}

TEST(OwnerLock, OfWhatSomebodyElseMayLeadElsewhereIsRefused) {
  const TemporaryFolder folder;
  const std::filesystem::path elsewhere = folder.path() / "elsewhere";
  std::filesystem::create_directory(elsewhere);
  for (const char* const name : {"spool", "checkpoints", "failures", "logs", "backup", "requests", "aside"}) {
    const CampaignDirectory directory(folder.path() / (std::string("with-") + name));
    std::filesystem::create_directory(directory.root());
    std::filesystem::create_symlink(elsewhere, directory.root() / name);
    EXPECT_THROW(OwnerLock{directory}, UnsuitableFile) << name;
    EXPECT_FALSE(std::filesystem::exists(directory.lock())) << name;
  }
  EXPECT_TRUE(std::filesystem::is_empty(elsewhere));
}

TEST(OwnerLock, IsNeverALink) {
  const TemporaryFolder folder;
  const CampaignDirectory directory(folder.path() / "campaign");
  std::filesystem::create_directory(directory.root());
  write_durably(folder.path() / "victim", "precious");
  std::filesystem::create_symlink(folder.path() / "victim", directory.lock());
  EXPECT_THROW(OwnerLock{directory}, UnsuitableFile);
  EXPECT_THROW(current_owner(directory), UnsuitableFile);
  EXPECT_EQ(read_file(folder.path() / "victim"), "precious");
}

// People do so if their scratch disk is elsewhere.
TEST(OwnerLock, TheFolderThatItsUserNamesMayBeALink) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() / "scratch");
  const CampaignDirectory directory(folder.path() / "campaign");
  std::filesystem::create_symlink("scratch", directory.root());
  const OwnerLock lock(directory);
  EXPECT_TRUE(std::filesystem::equivalent(lock.folder().value(), directory.root()));
  EXPECT_EQ(current_owner(directory), getpid());
}

TEST(OwnerLock, ASecondOwnerIsToldWhoOwnsTheCampaign) {
  const TemporaryFolder folder;
  const CampaignDirectory directory(folder.path());
  const OwnerLock lock(directory);
  try {
    const OwnerLock second(directory);
    FAIL() << "two owners";
  } catch (const OwnedByAnother& refusal) {
    EXPECT_NE(std::string(refusal.what()).find("process " + std::to_string(getpid())), std::string::npos);
  }
}

TEST(OwnerLock, HoldsWhenItsFileIsDeletedAndStillNamesItsHolder) {
  const TemporaryFolder folder;
  const CampaignDirectory directory(folder.path());
  const OwnerLock lock(directory);
  std::filesystem::remove(directory.lock());
  EXPECT_EQ(current_owner(directory), getpid());
  try {
    const OwnerLock second(directory);
    FAIL() << "two owners";
  } catch (const OwnedByAnother& refusal) {
    EXPECT_NE(std::string(refusal.what()).find("process " + std::to_string(getpid())), std::string::npos);
  }
}

TEST(OwnerLock, KnowsWhereItsFolderIs) {
  const TemporaryFolder folder;
  const CampaignDirectory directory(folder.path() / "one");
  std::filesystem::create_directory(directory.root());
  const OwnerLock lock(directory);
  EXPECT_EQ(lock.folder(), directory.root());
  std::filesystem::rename(directory.root(), folder.path() / "two");
  EXPECT_EQ(lock.folder(), folder.path() / "two");
  std::filesystem::remove_all(folder.path() / "two");
  EXPECT_EQ(lock.folder(), std::nullopt);
}

TEST(OwnerLock, EndsWithItsHolder) {
  const TemporaryFolder folder;
  const CampaignDirectory directory(folder.path());
  EXPECT_EQ(current_owner(directory), std::nullopt);
  {
    const OwnerLock lock(directory);
    EXPECT_EQ(current_owner(directory), getpid());
  }
  EXPECT_EQ(current_owner(directory), std::nullopt);
  EXPECT_NO_THROW(OwnerLock{directory});
}

TEST(OwnerLock, DiesWithAKilledProcess) {
  const TemporaryFolder folder;
  const CampaignDirectory directory(folder.path());
  const pid_t child = fork();
  if (child == 0) {
    const OwnerLock lock(directory);
    kill(getpid(), SIGKILL);
  }
  waitpid(child, nullptr, 0);
  EXPECT_NO_THROW(OwnerLock{directory});
}

}  // namespace
}  // namespace peclet::runner
