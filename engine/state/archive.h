// Writes and reads plain values as bytes of this machine in a fixed order: the content of a checkpoint.
#pragma once

#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "engine/state/vector_field.h"

namespace peclet::engine {

// Thrown if the bytes end too early or do not fit the system that they are read into.
class ArchiveError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class ArchiveWriter {
 public:
  template <class Value>
  requires std::is_trivially_copyable_v<Value>
  void put(const Value& value) { bytes_.append(reinterpret_cast<const char*>(&value), sizeof value); }

  template <class Value>
  requires std::is_trivially_copyable_v<Value>
  void put(const std::vector<Value>& values) {
    put(static_cast<std::uint64_t>(values.size()));
    bytes_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Value));
  }

  void put(const std::string& text) { put(std::vector<char>(text.begin(), text.end())); }

  void put(const VectorField& field) {
    put(static_cast<std::uint64_t>(field.size()));
    for (std::size_t i = 0; i < field.size(); ++i) put(field[i]);
  }

  // Writes plain values, texts, fields, objects that save themselves, and vectors of these.
  template <class... Parts>
  void put_all(const Parts&... parts) {
    (put_part(parts), ...);
  }

  const std::string& bytes() const { return bytes_; }

 private:
  template <class Part>
  void put_part(const Part& part) {
    if constexpr (requires { part.save(*this); }) {
      part.save(*this);
    } else if constexpr (requires { put(part); }) {
      put(part);
    } else {
      for (const auto& one : part) put_part(one);
    }
  }

  std::string bytes_;
};

class ArchiveReader {
 public:
  explicit ArchiveReader(std::string_view bytes) : rest_(bytes) {}

  template <class Value>
  Value get() {
    static_assert(std::is_trivially_copyable_v<Value>);
    Value value;
    std::memcpy(&value, take(sizeof value), sizeof value);
    return value;
  }

  template <class Value>
  std::vector<Value> get_vector(std::size_t expected) {
    const auto count = get<std::uint64_t>();
    if (count != expected) {
      throw ArchiveError("holds " + std::to_string(count) + " values where " + std::to_string(expected) +
                         " belong");
    }
    std::vector<Value> values(expected);
    if (expected > 0) std::memcpy(values.data(), take(expected * sizeof(Value)), expected * sizeof(Value));
    return values;
  }

  std::string get_string() {
    const auto count = get<std::uint64_t>();
    if (count > rest_.size()) throw ArchiveError("ends too early");
    return std::string(take(count), count);
  }

  // Reads parts that put_all() wrote. Throws ArchiveError if a vector or field was written with another size.
  template <class... Parts>
  void get_all(Parts&... parts) {
    (get_part(parts), ...);
  }

  bool at_end() const { return rest_.empty(); }

 private:
  VectorField get_field(std::size_t expected) {
    const std::vector<Vector3> vectors = get_vector<Vector3>(expected);
    VectorField field(expected);
    for (std::size_t i = 0; i < expected; ++i) field.set(i, vectors[i]);
    return field;
  }

  template <class Part>
  void get_part(Part& part) {
    if constexpr (requires { part.load(*this); }) {
      part.load(*this);
    } else if constexpr (std::is_same_v<Part, std::string>) {
      part = get_string();
    } else if constexpr (std::is_same_v<Part, VectorField>) {
      part = get_field(part.size());
    } else if constexpr (std::is_trivially_copyable_v<Part>) {
      part = get<Part>();
    } else if constexpr (std::is_trivially_copyable_v<typename Part::value_type>) {
      part = get_vector<typename Part::value_type>(part.size());
    } else {
      for (auto& one : part) get_part(one);
    }
  }

  const char* take(std::size_t count) {
    if (count > rest_.size()) throw ArchiveError("ends too early");
    const char* begin = rest_.data();
    rest_.remove_prefix(count);
    return begin;
  }

  std::string_view rest_;
};

}  // namespace peclet::engine
