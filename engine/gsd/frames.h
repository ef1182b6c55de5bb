// Frames of a GSD file on their way to it.
//
// A file grows by whole frames, header and index are written when it is finished: head() + the bytes of all
// frames + tail(). What has not been given to the file yet is `pending`; index, names and a checksum of each
// frame stay here, and are all that a checkpoint needs besides the file.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "engine/gsd/layout.h"
#include "engine/state/archive.h"

namespace peclet::engine::gsd {

// Bytes [begin, end) of the file.
struct FrameBytes {
  std::uint64_t begin, end;
  std::array<char, 64> sha256;
};

class Frames {
 public:
  // Adds a chunk to the present frame: rows of so many columns. Requires names in the same order in all
  // frames, though some may be left out, and no name twice in a frame; std::logic_error.
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
  // Where the next frame begins, and where the file ends as far as it is written.
  std::uint64_t length() const { return frames_.empty() ? sizeof(Header) : frames_.back().end; }
  std::uint64_t written() const { return length() - pending_.size(); }

  // Bytes of whole frames that belong at written().
  const std::string& pending() const { return pending_; }
  // The file has them.
  void hand_over() { pending_.clear(); }

  // Requires that nothing is left of an unfinished frame.
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
  std::string current_;  // the unfinished one
};

}  // namespace peclet::engine::gsd
