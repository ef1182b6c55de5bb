// Computes SHA-256 hashes, as lower-case hexadecimal.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace peclet {

std::string sha256(std::string_view bytes);
// Returns the SHA-256 in base64, as a Content-Security-Policy needs it.
std::string sha256_base64(std::string_view bytes);

// Returns the SHA-256 of the rest of an open file, piece by piece. Throws std::system_error naming the path.
std::string sha256_of_open(int file, const std::filesystem::path& path);

// Returns the SHA-256 of a file's content. Throws std::system_error naming the path.
std::string sha256_of_file(const std::filesystem::path& path);

// Hashes bytes as they come.
class Sha256 {
 public:
  Sha256();
  ~Sha256();
  Sha256(Sha256&&) noexcept;
  Sha256& operator=(Sha256&&) = delete;
  void add(std::string_view bytes);
  // Returns the hash of all bytes until now; more may be added.
  std::string hash() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace peclet
