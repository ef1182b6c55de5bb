// An open file that is closed when its owner goes.
#pragma once

#include <filesystem>
#include <string_view>
#include <utility>

namespace peclet {

class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  Descriptor(Descriptor&& other) noexcept : number_(other.take()) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  Descriptor& operator=(Descriptor&&) = delete;
  ~Descriptor();

  int number() const { return number_; }
  // Closing reports late write errors on some file systems; afterwards the destructor has nothing to do.
  int close();
  // Leaves it to the caller.
  int take() { return std::exchange(number_, -1); }

 private:
  int number_;
};

// As open(2) with O_CLOEXEC, again after a signal; a number below 0 with errno when it cannot be opened.
Descriptor open_file(const std::filesystem::path& path, int flags, unsigned mode = 0666);

// Writes every byte. Throws std::system_error naming the path.
void write_all(int descriptor, std::string_view bytes, const std::filesystem::path& path);

// Throws what errno says: "cannot open /the/path: ...".
[[noreturn]] void fail_to(const char* action, const std::filesystem::path& path);

}  // namespace peclet
