// A team works on one realisation: a block of threads of a card, or its emulation, one thread after the
// other.
//
// Kernels are loops between barriers. A loop that each member takes its share of writes nothing that another
// turn of the same loop reads. What stands between loops is computed by every member alike. Sums have a fixed
// order: the same bits from a card and from the emulation.
#pragma once

#include <cstdint>

#include "engine/state/real.h"

#ifndef PECLET_CARD_THREADS
#define PECLET_CARD_THREADS 512
#endif

namespace peclet::engine {

constexpr std::uint32_t card_threads = PECLET_CARD_THREADS;
constexpr std::uint32_t card_warp = 32, card_warps = card_threads / card_warp;
constexpr int most_card_sums = 48;

// Returns the k-th place of a member in an order from long rows to short ones: a long row with a short one.
PECLET_ALWAYS_INLINE constexpr std::uint32_t own_place(std::uint32_t member, std::uint32_t k) {
  return k % 2 == 0 ? k * card_threads + member : (k + 1) * card_threads - 1 - member;
}

constexpr int at_least_one(int count) { return count > 0 ? count : 1; }
template <int sums, int maxima>
struct CardSumsOf {
  double sum[at_least_one(sums)] = {}, largest[at_least_one(maxima)] = {};
};

// The rows of a loop over particles that one member keeps, up to most_own_rows.
#ifndef PECLET_CARD_OWN_ROWS
#define PECLET_CARD_OWN_ROWS 2
#endif
constexpr std::uint32_t most_own_rows = PECLET_CARD_OWN_ROWS;
template <class Row>
struct CardOwnRows {
  Row row[most_own_rows];
};

struct CardTotals {
  const double *sum, *largest;
};

#ifdef __CUDA__

class CardTeam {
 public:
  __device__ CardTeam() : member_(static_cast<std::uint32_t>(__nvvm_read_ptx_sreg_tid_x())) {}

  __device__ void meet() const { __syncthreads(); }

  // Calls body(i) for i from 0 to count - 1, and meets.
  template <class Body>
  PECLET_ALWAYS_INLINE __device__ void each(std::uint32_t count, Body&& body) const {
    for (std::uint32_t i = member_; i < count; i += card_threads) body(i);
    meet();
  }
  // Does the same with a row of `rows` for each i, which the member keeps from loop to loop.
  template <class Row, class Body>
  PECLET_ALWAYS_INLINE __device__ void each_own(std::uint32_t count, CardOwnRows<Row>& rows,
                                                Body&& body) const {
#pragma unroll
    for (std::uint32_t k = 0; k < most_own_rows; ++k) {
      const std::uint32_t i = own_place(member_, k);
      if (i < count) body(i, rows.row[k]);
    }
    meet();
  }
  template <class Row, class Body>
  PECLET_ALWAYS_INLINE __device__ void each_own(std::uint32_t count, Row* rows, Body&& body) const {
    each(count, [&](std::uint32_t i) PECLET_INLINE_LAMBDA { body(i, rows[i]); });
  }
  template <int sums, class Row, class Body>
  PECLET_ALWAYS_INLINE __device__ CardTotals reduce_own(std::uint32_t count, CardOwnRows<Row>& rows,
                                                        Body&& body) const {
    // The loop of reduce(), with its rows unrolled.
    return reduce_from<sums, 0>([&](auto& own) PECLET_INLINE_LAMBDA {
#pragma unroll
      for (std::uint32_t k = 0; k < most_own_rows; ++k) {
        const std::uint32_t i = own_place(member_, k);
        if (i < count) body(i, rows.row[k], own);
      }
    });
  }
  template <int sums, class Row, class Body>
  PECLET_ALWAYS_INLINE __device__ CardTotals reduce_own(std::uint32_t count, Row* rows, Body&& body) const {
    return reduce_from<sums, 0>([&](auto& own) PECLET_INLINE_LAMBDA {
      for (std::uint32_t k = 0; k * card_threads < count; ++k) {
        const std::uint32_t i = own_place(member_, k);
        if (i < count) body(i, rows[i], own);
      }
    });
  }

  // Calls body() once, and meets.
  template <class Body>
  PECLET_ALWAYS_INLINE __device__ void once(Body&& body) const {
    if (member_ == 0) body();
    meet();
  }

  // Calls body(i, own) for i from 0 to count - 1, which adds to the sums of `own` and raises its maxima, from
  // 0 on. Returns those of all, which are there until the next call.
  template <int sums, int maxima, class Body>
  PECLET_ALWAYS_INLINE __device__ CardTotals reduce(std::uint32_t count, Body&& body) const {
    return reduce_from<sums, maxima>([&](auto& own) PECLET_INLINE_LAMBDA {
      for (std::uint32_t i = member_; i < count; i += card_threads) body(i, own);
    });
  }
  // Adds up what add(own) makes for each member.
  template <int sums, int maxima, class Add>
  PECLET_ALWAYS_INLINE __device__ CardTotals reduce_from(Add&& add) const {
    static_assert(sums + maxima <= most_card_sums);
    auto& shared = scratch();
    CardSumsOf<sums, maxima> own;
    add(own);
#pragma unroll
    for (int k = 0; k < sums; ++k) {
#pragma unroll
      for (int offset = 16; offset > 0; offset /= 2) own.sum[k] += other(own.sum[k], offset);
    }
#pragma unroll
    for (int k = 0; k < maxima; ++k) {
#pragma unroll
      for (int offset = 16; offset > 0; offset /= 2) {
        const double seen = other(own.largest[k], offset);
        own.largest[k] = own.largest[k] < seen ? seen : own.largest[k];
      }
    }
    if (member_ % card_warp == 0) {
#pragma unroll
      for (int k = 0; k < sums; ++k) shared[k][member_ / card_warp] = own.sum[k];
#pragma unroll
      for (int k = 0; k < maxima; ++k) shared[sums + k][member_ / card_warp] = own.largest[k];
    }
    meet();
    double* const total = totals();
    if (member_ < sums + maxima) {
      double all = 0;
      for (std::uint32_t w = 0; w < card_warps; ++w) {
        const double part = shared[member_][w];
        all = member_ < sums ? all + part : all < part ? part : all;
      }
      total[member_] = all;
    }
    meet();
    return {total, total + sums};
  }

  // Sets begin[i] to the sum of count[0] to count[i - 1], for i from 0 to `size`. Returns the sum of all.
  __device__ std::uint32_t scan(std::uint32_t size, const std::uint32_t* count, std::uint32_t* begin) const {
    __shared__ std::uint32_t part[card_threads];
    const std::uint32_t share = (size + card_threads - 1) / card_threads;
    const std::uint32_t from = member_ * share, to = from + share < size ? from + share : size;
    std::uint32_t sum = 0;
    for (std::uint32_t i = from; i < to; ++i) sum += count[i];
    part[member_] = sum;
    meet();
    std::uint32_t before = 0, all = 0;
    for (std::uint32_t m = 0; m < card_threads; ++m) {
      before += m < member_ ? part[m] : 0;
      all += part[m];
    }
    for (std::uint32_t i = from; i < to; ++i) {
      begin[i] = before;
      before += count[i];
    }
    if (member_ == 0) begin[size] = all;
    meet();
    return all;
  }

  // True once the card's clock has passed `deadline` [ns].
  __device__ bool is_late(std::uint64_t deadline) const {
    __shared__ bool late;
    if (member_ == 0) late = now() >= deadline;
    meet();
    const bool result = late;
    meet();
    return result;
  }
  // Returns the cycles of the multiprocessor.
  __device__ std::uint64_t cycles() const {
    std::uint64_t cycles;
    asm volatile("mov.u64 %0, %%clock64;" : "=l"(cycles));
    return cycles;
  }
  __device__ std::uint64_t now() const {
    std::uint64_t time;
    asm volatile("mov.u64 %0, %%globaltimer;" : "=l"(time));
    return time;
  }

 private:
  // One array serves all loops.
  __device__ static double (&scratch())[most_card_sums][card_warps] {
    __shared__ double shared[most_card_sums][card_warps];
    return shared;
  }
  __device__ static double* totals() {
    __shared__ double total[most_card_sums];
    return total;
  }
  __device__ static double other(double x, int offset) {
    const auto bits = __builtin_bit_cast(std::uint64_t, x);
    const auto low = static_cast<std::uint32_t>(
        __nvvm_shfl_sync_bfly_i32(0xffffffffU, static_cast<int>(bits), offset, 0x1f));
    const auto high = static_cast<std::uint32_t>(
        __nvvm_shfl_sync_bfly_i32(0xffffffffU, static_cast<int>(bits >> 32), offset, 0x1f));
    return __builtin_bit_cast(double, std::uint64_t{high} << 32 | low);
  }

  std::uint32_t member_;
};

#else

class CardTeam {
 public:
  void meet() const {}

  template <class Body>
  void each(std::uint32_t count, Body&& body) const {
    for (std::uint32_t i = 0; i < count; ++i) body(i);
  }
  template <class Row, class Body>
  void each_own(std::uint32_t count, Row* rows, Body&& body) const {
    for (std::uint32_t i = 0; i < count; ++i) body(i, rows[i]);
  }
  template <int sums, class Row, class Body>
  CardTotals reduce_own(std::uint32_t count, Row* rows, Body&& body) const {
    return reduce_from<sums, 0>([&](std::uint32_t member, auto& own) {
      for (std::uint32_t k = 0; k * card_threads < count; ++k) {
        const std::uint32_t i = own_place(member, k);
        if (i < count) body(i, rows[i], own);
      }
    });
  }
  template <class Body>
  void once(Body&& body) const {
    body();
  }

  template <int sums, int maxima, class Body>
  CardTotals reduce(std::uint32_t count, Body&& body) const {
    return reduce_from<sums, maxima>([&](std::uint32_t member, auto& own) {
      for (std::uint32_t i = member; i < count; i += card_threads) body(i, own);
    });
  }
  // Adds up what add(member, own) makes.
  template <int sums, int maxima, class Add>
  CardTotals reduce_from(Add&& add) const {
    static_assert(sums + maxima <= most_card_sums);
    double* const total = totals_;
    for (int k = 0; k < sums + maxima; ++k) total[k] = 0;
    for (std::uint32_t w = 0; w < card_warps; ++w) {
      CardSumsOf<sums, maxima> lane[card_warp];
      for (std::uint32_t l = 0; l < card_warp; ++l) add(w * card_warp + l, lane[l]);
      for (std::uint32_t offset = card_warp / 2; offset > 0; offset /= 2) {
        for (std::uint32_t l = 0; l < offset; ++l) {
          for (int k = 0; k < sums; ++k) lane[l].sum[k] += lane[l + offset].sum[k];
          for (int k = 0; k < maxima; ++k) raise(lane[l].largest[k], lane[l + offset].largest[k]);
        }
      }
      for (int k = 0; k < sums; ++k) total[k] += lane[0].sum[k];
      for (int k = 0; k < maxima; ++k) raise(total[sums + k], lane[0].largest[k]);
    }
    return {total, total + sums};
  }

  std::uint32_t scan(std::uint32_t size, const std::uint32_t* count, std::uint32_t* begin) const {
    std::uint32_t sum = 0;
    for (std::uint32_t i = 0; i < size; ++i) {
      begin[i] = sum;
      sum += count[i];
    }
    return begin[size] = sum;
  }

  bool is_late(std::uint64_t /*deadline*/) const { return false; }
  std::uint64_t now() const { return 0; }
  std::uint64_t cycles() const { return 0; }

 private:
  static void raise(double& largest, double seen) { largest = largest < seen ? seen : largest; }

  mutable double totals_[most_card_sums];
};

#endif

}  // namespace peclet::engine
