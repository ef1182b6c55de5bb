// Layout of a GSD file, version 2.0 (https://gsd.readthedocs.io, "File layer"): a header of 256 bytes, the
// data chunks of frame after frame, and an index of 32 bytes for each chunk, sorted by frame and by name,
// with the list of the names that it counts. Numbers are little-endian.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

namespace peclet::engine::gsd {

static_assert(std::endian::native == std::endian::little, "what is in memory is what is in the file");

constexpr std::uint64_t magic = 0x65DF65DF65DF65DF;
constexpr std::uint32_t version(std::uint32_t major, std::uint32_t minor) { return major << 16 | minor; }

struct Header {
  std::uint64_t magic;
  std::uint64_t index_location, index_entries;  // entries that there is room for
  std::uint64_t names_location, names_segments;
  std::uint32_t schema_version, file_version;
  char application[64], schema[64], reserved[80];
};
static_assert(sizeof(Header) == 256);

// The list of names is a whole number of these.
constexpr std::size_t segment = 64;

struct IndexEntry {
  std::uint64_t frame;
  std::uint64_t rows;
  std::int64_t location;  // from the file's beginning; 0 behind the last entry
  std::uint32_t columns;
  std::uint16_t name;
  std::uint8_t type, flags;
};
static_assert(sizeof(IndexEntry) == 32);

// Numbers of the types of values.
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

}  // namespace peclet::engine::gsd
