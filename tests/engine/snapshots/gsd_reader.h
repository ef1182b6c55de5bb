// A reader written from the published layout alone, with the offsets of the specification's structs.
#pragma once

#include <cstdint>
#include <cstring>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace peclet::engine {

template <class Value>
Value value_at(const std::string& bytes, std::size_t place) {
  Value value;
  if (place + sizeof value > bytes.size()) throw std::out_of_range("beyond the end of the file");
  std::memcpy(&value, bytes.data() + place, sizeof value);
  return value;
}

class GsdReader {
 public:
  struct Chunk {
    std::uint64_t frame, rows, location;
    std::uint32_t columns;
    std::uint16_t name;
    std::uint8_t type, flags;
  };

  // Throws std::exception if the bytes are not a GSD file.
  explicit GsdReader(std::string bytes) : bytes_(std::move(bytes)) {
    if (value_at<std::uint64_t>(bytes_, 0) != 0x65DF65DF65DF65DF) throw std::runtime_error("no GSD file");
    const auto names = value_at<std::uint64_t>(bytes_, 24), segments = value_at<std::uint64_t>(bytes_, 32);
    for (std::size_t at = names; bytes_.at(at) != 0; at += names_.back().size() + 1) {
      if (at >= names + 64 * segments) throw std::runtime_error("the list of names does not end");
      names_.emplace_back(bytes_.c_str() + at);
    }
    const auto index = value_at<std::uint64_t>(bytes_, 8), entries = value_at<std::uint64_t>(bytes_, 16);
    for (std::uint64_t k = 0; k < entries; ++k) {
      const std::size_t at = index + 32 * k;
      const Chunk chunk{value_at<std::uint64_t>(bytes_, at),      value_at<std::uint64_t>(bytes_, at + 8),
                        value_at<std::uint64_t>(bytes_, at + 16), value_at<std::uint32_t>(bytes_, at + 24),
                        value_at<std::uint16_t>(bytes_, at + 28), value_at<std::uint8_t>(bytes_, at + 30),
                        value_at<std::uint8_t>(bytes_, at + 31)};
      if (chunk.location == 0) break;
      chunks_.push_back(chunk);
      found_[{chunk.frame, names_.at(chunk.name)}] = chunk;
    }
  }

  std::string text(std::size_t place) const { return bytes_.c_str() + place; }
  const std::vector<std::string>& names() const { return names_; }
  const std::vector<Chunk>& chunks() const { return chunks_; }
  std::uint64_t frames() const { return chunks_.empty() ? 0 : chunks_.back().frame + 1; }
  bool has(std::uint64_t frame, const std::string& name) const { return found_.contains({frame, name}); }
  const Chunk& chunk(std::uint64_t frame, const std::string& name) const { return found_.at({frame, name}); }

  template <class Value>
  std::vector<Value> get(std::uint64_t frame, const std::string& name) const {
    const Chunk& found = chunk(frame, name);
    std::vector<Value> values;
    for (std::uint64_t k = 0; k < found.rows * found.columns; ++k) {
      values.push_back(value_at<Value>(bytes_, found.location + k * sizeof(Value)));
    }
    return values;
  }

 private:
  std::string bytes_;
  std::vector<std::string> names_;
  std::vector<Chunk> chunks_;
  std::map<std::pair<std::uint64_t, std::string>, Chunk> found_;
};

}  // namespace peclet::engine
