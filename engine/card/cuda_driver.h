// An NVIDIA card, through the driver's library, which is loaded when it is first asked for. No toolkit is
// needed, neither to build nor to run.
//
// A card is current in the thread that made it; any other thread calls use() before it touches memory,
// kernels or streams of it. A card outlives what is made on it. After a fork the child cannot use a card of
// its parent.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <ranges>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>

namespace peclet::engine {

// A call of the driver that failed: its name, the driver's words, and the compiler's log where there is one.
class CardError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Returns in one sentence why the first card cannot be used, or nothing if it can.
std::optional<std::string> why_no_card();

// The primary context of a card. Throws CardError if there is no such card, or none that can run our
// programs.
class Card {
 public:
  explicit Card(int ordinal = 0);
  ~Card();
  Card(const Card&) = delete;
  Card& operator=(const Card&) = delete;

  // Makes this card the current one of the calling thread.
  void use() const;
  // Waits until all copies without a stream have reached the card.
  void finish_copies() const;

  const std::string& name() const { return name_; }
  int compute_capability() const { return compute_capability_; }  // 90 for 9.0
  int multiprocessors() const { return multiprocessors_; }
  // The most dynamic shared memory of a block, after CardKernel::allow_shared() [bytes].
  std::size_t shared_memory_per_block() const { return shared_memory_per_block_; }
  std::size_t l2_size() const { return l2_size_; }  // [bytes]

 private:
  int device_;
  void* context_ = nullptr;
  std::string name_;
  int compute_capability_, multiprocessors_;
  std::size_t shared_memory_per_block_, l2_size_;
};

// A queue of launches and copies, beside those without a stream. finish_copies() orders the two.
class CardStream {
 public:
  CardStream();
  ~CardStream();
  CardStream(const CardStream&) = delete;
  CardStream& operator=(const CardStream&) = delete;

  // Waits until all is done. Throws CardError if a kernel failed.
  void synchronize() const;
  // Returns whether all is done. Throws CardError if a kernel failed.
  bool done() const;
  void* handle() const { return stream_; }

 private:
  void* stream_ = nullptr;
};

// A buffer on the current card. Ranges are arrays of trivial values; offsets are in bytes. Throws CardError
// if a range does not fit.
class CardMemory {
 public:
  explicit CardMemory(std::size_t bytes);
  ~CardMemory();
  CardMemory(CardMemory&& other) noexcept;
  CardMemory& operator=(CardMemory&& other) noexcept;

  std::size_t size() const { return size_; }
  // A kernel's argument for this buffer is a pointer to its address. It stays the same object until a move.
  const std::uint64_t& address() const { return address_; }

  template <std::ranges::contiguous_range Range>
  void upload(const Range& values, std::size_t offset = 0) {
    copy_in(std::as_bytes(of_trivial(std::span(values))), offset);
  }
  // Queues the copy: the values must not change before the stream is done.
  template <std::ranges::contiguous_range Range>
  void upload(const Range& values, const CardStream& stream, std::size_t offset = 0) {
    copy_in(std::as_bytes(of_trivial(std::span(values))), offset, stream);
  }
  // Fills the range, after all that was queued before.
  template <std::ranges::contiguous_range Range>
  void download(Range&& values, std::size_t offset = 0) const {
    copy_out(std::as_writable_bytes(of_trivial(std::span(values))), offset);
  }
  // Sets every byte.
  void fill(unsigned char byte);

 private:
  template <class Span>
  static Span of_trivial(Span values) {
    static_assert(std::is_trivially_copyable_v<typename Span::value_type>);
    return values;
  }
  void copy_in(std::span<const std::byte> values, std::size_t offset);
  void copy_in(std::span<const std::byte> values, std::size_t offset, const CardStream& stream);
  void copy_out(std::span<std::byte> values, std::size_t offset) const;
  std::uint64_t place(std::size_t offset, std::size_t bytes) const;

  std::uint64_t address_ = 0;
  std::size_t size_ = 0;
};

// A function of a module, with what the compiler gave it. Valid as long as its module.
class CardKernel {
 public:
  int registers() const { return registers_; }                  // of a thread
  int local_bytes() const { return local_bytes_; }              // of a thread: stack and spilled registers
  int shared_bytes() const { return shared_bytes_; }            // of a block, without dynamic shared memory
  int threads_per_block() const { return threads_per_block_; }  // at most

  // Allows launches with this much dynamic shared memory, which is needed above 48 KiB.
  void allow_shared(std::size_t bytes) const;
  // Returns how many blocks a multiprocessor has at once.
  int blocks_per_multiprocessor(int threads, std::size_t dynamic_shared_bytes) const;
  // Queues the kernel. `arguments` points to the place of each argument; they are read before the call
  // returns.
  void launch(unsigned grid, unsigned block, std::size_t dynamic_shared_bytes, void** arguments,
              const CardStream& stream) const;

 private:
  friend class CardModule;
  explicit CardKernel(void* function);

  void* function_;
  int registers_, local_bytes_, shared_bytes_, threads_per_block_;
};

// A program that the driver compiles from PTX for the current card, which can take seconds; later processes
// find it in the driver's cache, unless CUDA_CACHE_DISABLE=1. Throws CardError with the compiler's log.
class CardModule {
 public:
  explicit CardModule(std::string_view ptx);
  ~CardModule();
  CardModule(const CardModule&) = delete;
  CardModule& operator=(const CardModule&) = delete;

  CardKernel kernel(const std::string& name) const;

 private:
  void* module_ = nullptr;
};

}  // namespace peclet::engine
