// A GSD file that somebody else may have made.
//
// Nothing in it is believed: every place and count is compared with the length of the file before anything is
// read or memory is taken. Faults are InputError, which names the file and what is wrong.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "contract/descriptor.h"
#include "engine/gsd/layout.h"

namespace peclet::engine::gsd {

class Reader {
 public:
  // Reads header, names and index. Takes files of layout 2 and schema "hoomd" 1. Throws InputError.
  explicit Reader(const std::filesystem::path& path);

  std::uint64_t frames() const { return index_.empty() ? 0 : index_.back().frame + 1; }
  const std::filesystem::path& path() const { return path_; }

  // The chunk of that frame; null where it has none of that name.
  const IndexEntry* find(std::uint64_t frame, std::string_view name) const;
  // All chunks of that frame, by their places in names().
  std::span<const IndexEntry> chunks(std::uint64_t frame) const;
  // Names of all chunks of all frames.
  const std::vector<std::string>& names() const { return names_; }

  // The values of a chunk, row after row. Throws InputError where it holds another type or has other columns.
  template <class Value>
  std::vector<Value> get(const IndexEntry& chunk, std::uint32_t columns = 1) const {
    static_assert(type_of<Value> != 0);
    check(chunk, type_of<Value>, columns);
    std::vector<Value> values(chunk.rows * columns);
    read(static_cast<std::uint64_t>(chunk.location), std::as_writable_bytes(std::span(values)));
    return values;
  }

  // What is wrong with this file, for what is read from it.
  [[noreturn]] void refuse(const std::string& value, const std::string& allowed) const;

 private:
  void read(std::uint64_t place, std::span<std::byte> bytes) const;
  std::string read_text(std::uint64_t place, std::uint64_t length) const;
  // Whether so many bytes from there on are in the file.
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
  std::vector<IndexEntry> index_;  // by frame, then by name
};

// Whether a file begins as a GSD file does. False for what cannot be read.
bool begins_as_gsd(const std::filesystem::path& path);

}  // namespace peclet::engine::gsd
