#include "contract/sha256.h"

#include <fcntl.h>
#include <sodium.h>

#include <array>
#include <stdexcept>

#include "contract/durable_file.h"

namespace peclet {
namespace {

using Digest = std::array<unsigned char, crypto_hash_sha256_BYTES>;

void require_library() {
  static const bool ready = sodium_init() >= 0;
  if (!ready) throw std::runtime_error("libsodium cannot be initialised");
}

Digest digest_of(std::string_view bytes) {
  require_library();
  Digest digest{};
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast): bytes are bytes
  crypto_hash_sha256(digest.data(), reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
  return digest;
}

std::string hexadecimal(const Digest& digest) {
  std::string text(2 * digest.size() + 1, '\0');  // sodium appends a zero
  sodium_bin2hex(text.data(), text.size(), digest.data(), digest.size());
  text.pop_back();
  return text;
}

}  // namespace

std::string sha256(std::string_view bytes) { return hexadecimal(digest_of(bytes)); }

std::string sha256_base64(std::string_view bytes) {
  const Digest digest = digest_of(bytes);
  constexpr int variant = sodium_base64_VARIANT_ORIGINAL;
  std::string text(sodium_base64_ENCODED_LEN(digest.size(), variant),
                   '\0');  // the length includes a final zero
  sodium_bin2base64(text.data(), text.size(), digest.data(), digest.size(), variant);
  text.pop_back();
  return text;
}

std::string sha256_of_open(int file, const std::filesystem::path& path) {
  Sha256 hash;
  read_pieces(file, path, [&](std::string_view piece) { hash.add(piece); });
  return hash.hash();
}

std::string sha256_of_file(const std::filesystem::path& path) {
  const Descriptor file = open_file(path, O_RDONLY);
  if (file.number() < 0) fail_to("cannot open", path);
  return sha256_of_open(file.number(), path);
}

struct Sha256::State {
  crypto_hash_sha256_state state{};
};

Sha256::Sha256() : state_(std::make_unique<State>()) {
  require_library();
  crypto_hash_sha256_init(&state_->state);
}

Sha256::~Sha256() = default;
Sha256::Sha256(Sha256&&) noexcept = default;

void Sha256::add(std::string_view bytes) {
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast): bytes are bytes
  crypto_hash_sha256_update(&state_->state, reinterpret_cast<const unsigned char*>(bytes.data()),
                            bytes.size());
}

std::string Sha256::hash() const {
  crypto_hash_sha256_state until_now = state_->state;
  Digest digest{};
  crypto_hash_sha256_final(&until_now, digest.data());
  return hexadecimal(digest);
}

}  // namespace peclet
