#include "contract/guarded_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstring>

#include "contract/durable_file.h"
#include "tests/contract/refusal.h"
#include "tests/contract/temporary_folder.h"

namespace peclet {
namespace {

namespace fs = std::filesystem;

class GuardedFile : public FolderOfTest {
 protected:
  fs::path fifo() const {
    EXPECT_EQ(mkfifo((folder() / "fifo").c_str(), 0600), 0);
    return folder() / "fifo";
  }
  fs::path socket() const {
    const int descriptor = ::socket(AF_UNIX, SOCK_STREAM, 0);
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::strncpy(address.sun_path, (folder() / "socket").c_str(), sizeof address.sun_path - 1);
    EXPECT_EQ(bind(descriptor, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    close(descriptor);
    return folder() / "socket";
  }
  fs::path link(const fs::path& to) const {
    fs::create_symlink(to, folder() / "link");
    return folder() / "link";
  }
};

std::string refusal(const fs::path& path, int flags) {
  return refusal_by<UnsuitableFile>([&] { open_regular(path, flags); });
}

TEST_F(GuardedFile, NothingButARegularFileIsOpened) {
  const fs::path victim = folder() / "victim";
  write_durably(victim, "precious");
  for (const int flags : {O_RDONLY, O_WRONLY, O_RDWR | O_CREAT | O_TRUNC, O_WRONLY | O_CREAT | O_APPEND}) {
    fs::remove_all(folder() / "link");
    EXPECT_TRUE(contains(refusal(link(victim), flags), "is a link: must be a regular file"));
    for (const char* target : {"link", "absent"}) {
      fs::remove(folder() / "link");
      EXPECT_TRUE(contains(refusal(link(target), flags), "is a link"));
    }
    EXPECT_FALSE(fs::exists(folder() / "absent"));
    EXPECT_TRUE(contains(refusal(folder(), flags), "is a folder"));
    EXPECT_TRUE(contains(refusal("/dev/null", flags), "is a device"));
  }
  EXPECT_EQ(read_file(victim), "precious");
}

// Opening one side of a FIFO waits for the other; a fault would make this test hang.
TEST_F(GuardedFile, NobodyWaitsForAFifoOrASocket) {
  const fs::path pipe = fifo();
  EXPECT_TRUE(contains(refusal(pipe, O_RDONLY), "is a FIFO"));
  EXPECT_TRUE(contains(refusal(pipe, O_WRONLY), "is a FIFO"));
  EXPECT_TRUE(contains(refusal(socket(), O_RDONLY), "is a socket"));
  EXPECT_THROW(read_regular(pipe, 10), UnsuitableFile);
}

TEST_F(GuardedFile, ARegularFileIsOpenedAsOpenDoesIt) {
  const fs::path file = folder() / "file";
  EXPECT_THROW(open_regular(file, O_RDONLY), std::system_error);
  {
    const Descriptor made = open_regular(file, O_WRONLY | O_CREAT | O_APPEND, 0600);
    write_all(made.number(), "one", file);
    EXPECT_EQ(fcntl(made.number(), F_GETFL) & O_NONBLOCK, 0);
    EXPECT_NE(fcntl(made.number(), F_GETFD) & FD_CLOEXEC, 0);
  }
  write_all(open_regular(file, O_WRONLY | O_APPEND).number(), "two", file);
  EXPECT_EQ(read_regular(file, 6), "onetwo");
  EXPECT_THROW(read_regular(file, 5), UnsuitableFile);
}

// A sparse terabyte takes no disk space.
TEST_F(GuardedFile, ASparseFileIsNotRead) {
  const fs::path file = folder() / "sparse";
  write_durably(file, "");
  fs::resize_file(file, std::uintmax_t{1} << 40);
  EXPECT_THROW(read_regular(file, 1 << 20), UnsuitableFile);
}

TEST_F(GuardedFile, AFolderIsOnesOwnAndNoLink) {
  require_own_folder(folder());
  require_own_folder(folder() / "absent");
  require_own_folder("/");  // owned by root
  const fs::path alias = link(folder());
  EXPECT_THROW(require_own_folder(alias), UnsuitableFile);
  require_own_folder(alias, true);
  write_durably(folder() / "file", "");
  EXPECT_THROW(require_own_folder(folder() / "file"), UnsuitableFile);
  // A folder of an ordinary user is refused to any other user, including root.
  const fs::path foreign = folder() / "foreign";
  fs::create_directory(foreign);
  if (geteuid() == 0) {
    ASSERT_EQ(chown(foreign.c_str(), 12345, 12345), 0);
  }
  const uid_t other = geteuid() == 0 ? 0 : geteuid() + 1;
  const std::string message = refusal_by<UnsuitableFile>([&] { require_own_folder(foreign, false, other); });
  EXPECT_TRUE(contains(message, "belongs to the user"));
  EXPECT_TRUE(contains(message, fmt::format("`sudo chown -R {} {}`", user_name(other), foreign.string())));
}

TEST_F(GuardedFile, ACopyIsThatOfARegularFile) {
  write_durably(folder() / "from", std::string(200'000, 'x'));
  copy_regular(folder() / "from", folder() / "to", 200'000);
  EXPECT_EQ(read_file(folder() / "to"), std::string(200'000, 'x'));
  EXPECT_THROW(copy_regular(folder() / "from", folder() / "other", 199'999), UnsuitableFile);
  EXPECT_THROW(copy_regular(link(folder() / "from"), folder() / "other", 200'000), UnsuitableFile);
  EXPECT_FALSE(fs::exists(folder() / "other"));
}

}  // namespace
}  // namespace peclet
