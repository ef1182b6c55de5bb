#include "contract/sha256.h"

#include <sodium.h>

#include <array>
#include <stdexcept>

#include "contract/durable_file.h"

namespace peclet {

std::string sha256(std::string_view bytes) {
  static const bool ready = sodium_init() >= 0;
  if (!ready) throw std::runtime_error("libsodium cannot be initialised");

  std::array<unsigned char, crypto_hash_sha256_BYTES> digest{};
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast): bytes are bytes
  crypto_hash_sha256(digest.data(), reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());

  std::string text(2 * digest.size() + 1, '\0');  // sodium ends it with a zero
  sodium_bin2hex(text.data(), text.size(), digest.data(), digest.size());
  text.pop_back();
  return text;
}

std::string sha256_of_file(const std::filesystem::path& path) { return sha256(read_file(path)); }

}  // namespace peclet
