#include "runner/store/result_text.h"

#include <fmt/format.h>
#include <zlib.h>

#include <array>
#include <new>
#include <stdexcept>

#include "contract/integrity_error.h"
#include "runner/store/result_shape.h"

namespace peclet::runner {
namespace {

// zlib only reads its input, but takes it as a pointer to what may be written.
Bytef* bytes_of(std::string_view text) {
  return const_cast<Bytef*>(reinterpret_cast<const Bytef*>(text.data()));
}

uInt size_of(std::string_view text) { return static_cast<uInt>(text.size()); }

class Deflation {
 public:
  Deflation() {
    // Digits repeat by chance: matches that short are no gain, and the filtered strategy leaves them out.
    if (deflateInit2(&stream_, 5, Z_DEFLATED, MAX_WBITS, MAX_MEM_LEVEL - 1, Z_FILTERED) != Z_OK) {
      throw std::bad_alloc();
    }
  }
  ~Deflation() { deflateEnd(&stream_); }
  Deflation(const Deflation&) = delete;
  Deflation& operator=(const Deflation&) = delete;

  // As if it had never run before.
  std::string run(std::string_view text, std::string_view dictionary) {
    if (deflateReset(&stream_) != Z_OK) throw std::logic_error("zlib cannot begin anew");
    if (!dictionary.empty() &&
        deflateSetDictionary(&stream_, bytes_of(dictionary), size_of(dictionary)) != Z_OK) {
      throw std::logic_error("zlib refuses a dictionary");
    }
    std::string bytes(deflateBound(&stream_, text.size()), '\0');
    stream_.next_in = bytes_of(text);
    stream_.avail_in = size_of(text);
    stream_.next_out = reinterpret_cast<Bytef*>(bytes.data());
    stream_.avail_out = size_of(bytes);
    if (deflate(&stream_, Z_FINISH) != Z_STREAM_END) {
      throw std::logic_error("zlib needs more than its own bound");
    }
    bytes.resize(stream_.total_out);
    return bytes;
  }

 private:
  z_stream stream_{};
};

class Inflation {
 public:
  Inflation() {
    if (inflateInit(&stream_) != Z_OK) throw std::bad_alloc();
  }
  ~Inflation() { inflateEnd(&stream_); }
  Inflation(const Inflation&) = delete;
  Inflation& operator=(const Inflation&) = delete;

  std::string run(std::string_view bytes, std::string_view dictionary) {
    std::string text;
    std::array<char, 1 << 14> part{};
    stream_.next_in = bytes_of(bytes);
    stream_.avail_in = size_of(bytes);
    for (;;) {
      stream_.next_out = reinterpret_cast<Bytef*>(part.data());
      stream_.avail_out = static_cast<uInt>(part.size());
      const int code = inflate(&stream_, Z_NO_FLUSH);
      text.append(part.data(), part.size() - stream_.avail_out);
      if (text.size() > largest_result) {
        throw IntegrityError(fmt::format("inflates to more than {} bytes", largest_result));
      }
      if (code == Z_STREAM_END && stream_.avail_in == 0) return text;
      if (code == Z_NEED_DICT && is_taken(dictionary)) continue;
      if (code != Z_OK) throw IntegrityError(fmt::format("cannot be inflated: {}", reason(code)));
    }
  }

 private:
  // False: it is not the one with which the bytes were made.
  bool is_taken(std::string_view dictionary) {
    return inflateSetDictionary(&stream_, bytes_of(dictionary), size_of(dictionary)) == Z_OK;
  }
  const char* reason(int code) const {
    if (code == Z_NEED_DICT) return "its point's dictionary is not the one that it was made with";
    if (code == Z_STREAM_END) return "something follows its end";
    if (code == Z_BUF_ERROR) return "its end is missing";
    return stream_.msg != nullptr ? stream_.msg : zError(code);
  }

  z_stream stream_{};
};

}  // namespace

std::string deflated(std::string_view text, std::string_view dictionary) {
  // A stream has a quarter of a megabyte: taken and given back for each result, it makes the process give its
  // memory back, too, and fault it in again.
  thread_local Deflation deflation;
  return deflation.run(text, dictionary);
}

std::string inflated(std::string_view bytes, std::string_view dictionary) {
  return Inflation().run(bytes, dictionary);
}

// RFC 1950, 2.2: bit 5 of the second byte says that four more follow, with the dictionary's checksum.
bool was_deflated_with(std::string_view bytes, std::string_view dictionary) {
  constexpr std::size_t header = 6;
  constexpr unsigned has_dictionary = 0x20;
  if (bytes.size() < header || (static_cast<unsigned char>(bytes[1]) & has_dictionary) == 0) return true;
  uLong checksum = 0;
  for (std::size_t i = 2; i < header; ++i) checksum = checksum << 8U | static_cast<unsigned char>(bytes[i]);
  return checksum == adler32(adler32(0, nullptr, 0), bytes_of(dictionary), size_of(dictionary));
}

void store_result_text(Connection& connection, std::int64_t point, int seed, std::string_view text,
                       bool completed) {
  Statement known(connection, "SELECT text FROM dictionary WHERE point_id = ?");
  std::string dictionary;
  if (known.bind(point).step()) {
    dictionary = known.text(0);
    known.step();
  } else if (completed) {
    dictionary = text;
    Statement(connection, "INSERT INTO dictionary (point_id, text) VALUES (?, ?)")
        .bind(point)
        .bind(text)
        .run();
  }
  const std::string bytes = deflated(text, dictionary);
  Statement(connection, "INSERT INTO result (point_id, seed, document) VALUES (?, ?, ?)")
      .bind(point)
      .bind(seed)
      .bind_blob(bytes)
      .run();
}

std::string result_text(const Statement& query, int document, int dictionary) {
  std::string text = inflated(query.text(document), query.text(dictionary));
  if (const std::string excess = excess_of(text); !excess.empty()) {
    throw IntegrityError("is none that this program stores: " + excess);
  }
  return text;
}

}  // namespace peclet::runner
