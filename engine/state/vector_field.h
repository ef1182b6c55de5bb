// Stores one vector for each particle.
#pragma once

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "engine/state/real.h"
#include "engine/state/threads.h"
#include "engine/state/vector3.h"

namespace peclet::engine {

// A vector for each particle, in rows of four doubles: a vector is one aligned load from one cache line.
class VectorField {
 public:
  VectorField() = default;
  // Makes vectors of zero. `threads` threads write them, shared out as in loops over blocks: a page of memory
  // lies near the processor that writes to it first.
  explicit VectorField(std::size_t count, int threads = 1) : rows_(count) {
    for_each_index(count, threads, [&](std::size_t i) { rows_[i].v = Row{}; });
  }

  std::size_t size() const { return rows_.size(); }
  Vector3 operator[](std::size_t i) const { return {rows_[i].v[0], rows_[i].v[1], rows_[i].v[2]}; }
  void set(std::size_t i, const Vector3& v) { rows_[i].v = Row{v.x, v.y, v.z, 0}; }
  void add(std::size_t i, const Vector3& v) { rows_[i].v += Row{v.x, v.y, v.z, 0}; }

  Row& row(std::size_t i) { return rows_[i].v; }
  const Row& row(std::size_t i) const { return rows_[i].v; }
  // Returns the rows, one after the other.
  double* data() { return reinterpret_cast<double*>(rows_.data()); }
  const double* data() const { return reinterpret_cast<const double*>(rows_.data()); }

  friend bool operator==(const VectorField& a, const VectorField& b) {
    bool equal = a.size() == b.size();
    for (std::size_t i = 0; equal && i < a.size(); ++i) {
      const Row &p = a.row(i), &q = b.row(i);
      equal = p[0] == q[0] && p[1] == q[1] && p[2] == q[2];
    }
    return equal;
  }

 private:
  // Without registers of 32 bytes the compiler would align a bare row less.
  struct alignas(32) AlignedRow {
    Row v;
  };
  // Leaves new rows uninitialised.
  struct Allocator : std::allocator<AlignedRow> {
    template <class>
    struct rebind {
      using other = Allocator;
    };
    template <class... Arguments>
    void construct(AlignedRow* row, Arguments&&... arguments) {
      if constexpr (sizeof...(Arguments) > 0) {
        std::construct_at(row, std::forward<Arguments>(arguments)...);
      }
    }
  };
  std::vector<AlignedRow, Allocator> rows_;
};

}  // namespace peclet::engine
