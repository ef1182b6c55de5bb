#include "runner/page/tar_gz.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace peclet::runner {
namespace {

constexpr std::size_t block = 512;

// A header of ustar: fields at fixed places, numbers in octal digits.
class Header {
 public:
  Header(const std::string& folder, const ArchivedFile& file, std::int64_t time) {
    put(0, 100, file.name);
    put_octal(100, 8, file.executable ? 0755 : 0644);
    put_octal(108, 8, 0);  // user and group are left to whoever unpacks
    put_octal(116, 8, 0);
    put_octal(124, 12, file.bytes.size());
    put_octal(136, 12, static_cast<std::uint64_t>(std::max<std::int64_t>(0, time)));
    put(148, 8, "        ");  // the sum counts its own place as blanks
    put(156, 1, "0");         // a regular file
    put(257, 8,
        std::string("ustar\0"
                    "00",
                    8));
    put(345, 155, folder);  // stands before the name, with a slash
    std::uint64_t sum = 0;
    for (const char c : bytes_) sum += static_cast<unsigned char>(c);
    put(148, 8, fmt::format("{:06o}", sum) + std::string("\0 ", 2));
  }
  const std::string& bytes() const { return bytes_; }

 private:
  void put(std::size_t at, std::size_t room, const std::string& text) {
    if (text.size() > room) throw std::length_error(text + ": too long for an archive");
    bytes_.replace(at, text.size(), text);
  }
  // As many digits as there is room for, and a zero byte.
  void put_octal(std::size_t at, std::size_t room, std::uint64_t number) {
    const std::string digits = fmt::format("{:0{}o}", number, room - 1);
    if (digits.size() >= room)
      throw std::length_error("a file of more than 8 GiB is too long for an archive");
    put(at, room, digits);
  }

  std::string bytes_ = std::string(block, '\0');
};

class Stream {
 public:
  Stream() {
    constexpr int gzip_format = 16;
    if (deflateInit2(&stream_, Z_BEST_COMPRESSION, Z_DEFLATED, MAX_WBITS + gzip_format, MAX_MEM_LEVEL,
                     Z_DEFAULT_STRATEGY) != Z_OK) {
      throw std::runtime_error("zlib cannot begin");
    }
  }
  ~Stream() { deflateEnd(&stream_); }
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;
  z_stream& get() { return stream_; }

 private:
  z_stream stream_{};
};

}  // namespace

std::string tar(const std::string& folder, const std::vector<ArchivedFile>& files, std::int64_t time) {
  std::string archive;
  for (const ArchivedFile& file : files) {
    archive += Header(folder, file, time).bytes() + file.bytes;
    archive.resize((archive.size() + block - 1) / block * block, '\0');
  }
  // Two empty blocks are the end; tar writes twenty blocks at a time.
  constexpr std::size_t record = 20 * block;
  archive.resize((archive.size() + 2 * block + record - 1) / record * record, '\0');
  return archive;
}

std::string gzip(std::string_view bytes) {
  Stream stream;
  gz_header header{};
  header.os = 3;  // Unix, wherever zlib was built
  if (deflateSetHeader(&stream.get(), &header) != Z_OK) throw std::runtime_error("zlib takes no header");
  std::string packed;
  std::string chunk(1U << 16U, '\0');
  constexpr std::size_t most = std::numeric_limits<uInt>::max() / 2;
  int state = Z_OK;
  while (state != Z_STREAM_END) {
    const std::string_view part = bytes.substr(0, most);
    // zlib does not write there, but asks for a pointer that could.
    stream.get().next_in = const_cast<Bytef*>(reinterpret_cast<const Bytef*>(part.data()));
    stream.get().avail_in = static_cast<uInt>(part.size());
    bytes.remove_prefix(part.size());
    do {
      stream.get().next_out = reinterpret_cast<Bytef*>(chunk.data());
      stream.get().avail_out = static_cast<uInt>(chunk.size());
      state = deflate(&stream.get(), bytes.empty() ? Z_FINISH : Z_NO_FLUSH);
      if (state == Z_STREAM_ERROR) throw std::runtime_error("zlib cannot go on");
      packed.append(chunk, 0, chunk.size() - stream.get().avail_out);
    } while (stream.get().avail_out == 0);
  }
  return packed;
}

}  // namespace peclet::runner
