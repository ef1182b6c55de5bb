#include "engine/card/card_ptx.h"

#include <zlib.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <span>
#include <stdexcept>

#include "contract/sha256.h"

// In the assembly that cmake/card_programs.cmake writes: the files of gzip one after the other, and where
// each ends.
extern "C" {
extern const unsigned char peclet_card_ptx_bytes[];
extern const std::uint64_t peclet_card_ptx_ends[];
extern const std::uint64_t peclet_card_ptx_count;
}

namespace peclet::engine {
namespace {

std::string unpacked(std::span<const unsigned char> packed) {
  // The last four bytes are the length of the text, the lowest first (RFC 1952, section 2.3.1).
  std::size_t length = 0;
  for (const unsigned char byte : {packed.end()[-1], packed.end()[-2], packed.end()[-3], packed.end()[-4]}) {
    length = 256 * length + byte;
  }
  std::string text(length, '\0');
  z_stream stream{};
  stream.next_in = const_cast<Bytef*>(packed.data());  // zlib only reads it
  stream.avail_in = static_cast<uInt>(packed.size());
  stream.next_out = reinterpret_cast<Bytef*>(text.data());
  stream.avail_out = static_cast<uInt>(text.size());
  inflateInit2(&stream, 16 + MAX_WBITS);  // with the header of gzip
  const int end = inflate(&stream, Z_FINISH);
  inflateEnd(&stream);
  if (end != Z_STREAM_END) throw std::runtime_error("the packed PTX of this program is damaged");
  return text;
}

}  // namespace

std::string_view card_ptx(unsigned variant) {
  static std::array<std::string, PECLET_CARD_VARIANTS> texts;
  static std::mutex guard;
  if (variant >= peclet_card_ptx_count) return {};
  const std::lock_guard lock(guard);
  if (texts[variant].empty()) {
    const std::size_t begin = variant == 0 ? 0 : peclet_card_ptx_ends[variant - 1];
    texts[variant] = unpacked({peclet_card_ptx_bytes + begin, peclet_card_ptx_ends[variant] - begin});
  }
  return texts[variant];
}

std::string card_ptx_sha256() {
  std::string all;
  for (unsigned variant = 0; variant < peclet_card_ptx_count; ++variant) all += card_ptx(variant);
  return all.empty() ? "" : sha256(all);
}

}  // namespace peclet::engine
