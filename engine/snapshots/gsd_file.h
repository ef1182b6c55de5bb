// Writes and reads GSD files.
#pragma once

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "contract/durable_file.h"
#include "contract/errors.h"
#include "engine/state/archive.h"

namespace peclet::engine::gsd {

// The layout of a GSD file, version 2.0 (https://gsd.readthedocs.io, "File layer"): a header of 256 bytes,
// the data chunks frame after frame, the list of names, and an index with 32 bytes for each chunk, sorted by
// frame and name. Numbers are little-endian.
static_assert(std::endian::native == std::endian::little, "numbers are written as they are in memory");

constexpr std::uint64_t magic = 0x65DF65DF65DF65DF;
constexpr std::uint32_t version(std::uint32_t major, std::uint32_t minor) { return major << 16 | minor; }

struct Header {
  std::uint64_t magic;
  std::uint64_t index_location, index_entries;  // entries with room in the file
  std::uint64_t names_location, names_segments;
  std::uint32_t schema_version, file_version;
  char application[64], schema[64], reserved[80];
};
static_assert(sizeof(Header) == 256);

// The list of names is a whole number of segments [bytes].
constexpr std::size_t segment = 64;

struct IndexEntry {
  std::uint64_t frame;
  std::uint64_t rows;
  std::int64_t location;  // from the beginning of the file; 0 after the last entry
  std::uint32_t columns;
  std::uint16_t name;
  std::uint8_t type, flags;
};
static_assert(sizeof(IndexEntry) == 32);

// The numbers of the types of values.
template <class Value>
constexpr std::uint8_t type_of = 0;
template <>
inline constexpr std::uint8_t type_of<std::uint8_t> = 1;
template <>
inline constexpr std::uint8_t type_of<std::uint32_t> = 3;
template <>
inline constexpr std::uint8_t type_of<std::uint64_t> = 4;
template <>
inline constexpr std::uint8_t type_of<std::int8_t> = 5;
template <>
inline constexpr std::uint8_t type_of<std::int32_t> = 7;
template <>
inline constexpr std::uint8_t type_of<float> = 9;
template <>
inline constexpr std::uint8_t type_of<double> = 10;

// A frame as bytes [begin, end) of the file.
struct FrameBytes {
  std::uint64_t begin, end;
  std::array<char, 64> sha256;
};

// Collects the frames of a GSD file that is being written.
//
// The file grows by whole frames. Header and index are written when it is finished: head() + the bytes of all
// frames + tail(). Bytes that the file does not have yet are pending(). Index, names and a checksum of each
// frame stay here; a checkpoint needs only these besides the file.
class Frames {
 public:
  // Adds a chunk to the present frame, in rows of `columns` values. Names must come in the same order in all
  // frames; some may be left out. Throws std::logic_error if a name is out of order or occurs twice.
  template <class Value>
  void add(const std::string& name, const std::vector<Value>& values, std::uint32_t columns = 1) {
    static_assert(type_of<Value> != 0);
    add(name, {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Value)},
        values.size() / columns, columns, type_of<Value>);
  }
  template <class Value>
  void add_single(const std::string& name, Value value) {
    add(name, std::vector<Value>{value});
  }
  void end_frame();

  std::uint64_t count() const { return frames_.size(); }
  const std::vector<FrameBytes>& whole() const { return frames_; }
  // Return where the next frame begins, and where the written part of the file ends.
  std::uint64_t length() const { return frames_.empty() ? sizeof(Header) : frames_.back().end; }
  std::uint64_t written() const { return length() - pending_.size(); }

  // Returns the bytes of whole frames that belong at written().
  const std::string& pending() const { return pending_; }
  // Drops the pending bytes, which the file now has.
  void hand_over() { pending_.clear(); }

  // Return the header, and the names and the index. Require that no frame is unfinished.
  std::string head() const;
  std::string tail() const;

  void save(ArchiveWriter& archive) const;
  void load(ArchiveReader& archive);

 private:
  void add(const std::string& name, std::string_view bytes, std::uint64_t rows, std::uint32_t columns,
           std::uint8_t type);

  std::vector<std::string> names_;
  std::vector<IndexEntry> index_;
  std::vector<FrameBytes> frames_;
  std::string pending_;  // whole frames
  std::string current_;  // the unfinished frame
};

// Reads a GSD file of any origin.
//
// Every place and count is compared with the length of the file before data are read or memory is allocated.
// Faults throw InputError, which names the file and the fault.
class Reader {
 public:
  // Reads header, names and index. Throws InputError unless the file has layout 2 and schema "hoomd" 1.
  explicit Reader(const std::filesystem::path& path);

  std::uint64_t frames() const { return index_.empty() ? 0 : index_.back().frame + 1; }
  const std::filesystem::path& path() const { return path_; }

  // Returns the chunk of a frame with this name, or null.
  const IndexEntry* find(std::uint64_t frame, std::string_view name) const;
  // Returns all chunks of a frame, in the order of names().
  std::span<const IndexEntry> chunks(std::uint64_t frame) const;
  // Returns the names of the chunks of all frames.
  const std::vector<std::string>& names() const { return names_; }

  // Returns the values of a chunk, row after row. Throws InputError if its type or its columns differ.
  template <class Value>
  std::vector<Value> get(const IndexEntry& chunk, std::uint32_t columns = 1) const {
    static_assert(type_of<Value> != 0);
    check(chunk, type_of<Value>, columns);
    std::vector<Value> values(chunk.rows * columns);
    read(static_cast<std::uint64_t>(chunk.location), std::as_writable_bytes(std::span(values)));
    return values;
  }

  // Throws InputError for this file.
  template <class... Arguments>
  [[noreturn]] void refuse(const std::string& value, fmt::format_string<Arguments...> rule,
                           Arguments&&... arguments) const {
    throw InputError(path_.string(), "", value, fmt::format(rule, std::forward<Arguments>(arguments)...));
  }

 private:
  void read(std::uint64_t place, std::span<std::byte> bytes) const;
  std::string read_text(std::uint64_t place, std::uint64_t length) const;
  // True if the file has `length` bytes from `place` on.
  bool holds(std::uint64_t place, std::uint64_t length) const {
    return place <= length_ && length <= length_ - place;
  }
  Header checked_header() const;
  void read_names(const Header& header);
  void read_index(const Header& header);
  void check(const IndexEntry& chunk, std::uint8_t type, std::uint32_t columns) const;

  std::filesystem::path path_;
  Descriptor file_;
  std::uint64_t length_ = 0;
  std::vector<std::string> names_;
  std::map<std::string, std::uint16_t, std::less<>> number_of_name_;
  std::vector<IndexEntry> index_;  // sorted by frame, then by name
};

// Returns true if a file begins as a GSD file, and false if it cannot be read.
bool begins_as_gsd(const std::filesystem::path& path);

}  // namespace peclet::engine::gsd
