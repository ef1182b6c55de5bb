// A CUDA card as CardDevice.
#include <array>
#include <fstream>
#include <iterator>
#include <map>
#include <mutex>
#include <optional>
#include <span>
#include <stdexcept>

#include "engine/card/card_device.h"
#include "engine/card/card_ptx.h"
#include "engine/card/cuda_driver.h"

namespace peclet::engine {
namespace {

class CudaCard final : public CardDevice {
 public:
  CudaCard(int number, std::string programs) : card_(number), programs_folder_(std::move(programs)) {}

  std::string name() const override { return "cuda " + card_ptx_sha256().substr(0, 12); }
  std::size_t places(unsigned variant, std::size_t particles) const override {
    if (particles * sizeof(CardMotion) > program(variant).room) return 0;
    const int blocks =
        program(variant).kernel.blocks_per_multiprocessor(threads(variant), shared(variant, particles).bytes);
    return static_cast<std::size_t>(blocks) * static_cast<std::size_t>(card_.multiprocessors());
  }

  void* allocate(std::size_t bytes) override {
    card_.use();
    CardMemory memory(bytes);
    const std::uint64_t address = memory.address();
    const std::lock_guard lock(mutex_);
    memories_.emplace(address, std::move(memory));
    // NOLINTNEXTLINE(performance-no-int-to-ptr): the driver's addresses are numbers
    return reinterpret_cast<void*>(address);
  }
  void release(void* memory) override {
    card_.use();
    const std::lock_guard lock(mutex_);
    memories_.erase(reinterpret_cast<std::uint64_t>(memory));
  }
  void upload(void* to, const void* from, std::size_t bytes) override {
    card_.use();
    const auto [memory, offset] = place_of(to);
    memory.upload(std::span(static_cast<const std::byte*>(from), bytes), offset);
  }
  void download(void* to, const void* from, std::size_t bytes) override {
    card_.use();
    const auto [memory, offset] = place_of(from);
    memory.download(std::span(static_cast<std::byte*>(to), bytes), offset);
  }

  void begin(unsigned variant, std::size_t particles, const CardSlot* slots, std::size_t count,
             const CardBounds& bounds) override {
    card_.use();
    card_.finish_copies();
    const CardSlot* given = slots;
    const Shared near = shared(variant, particles);
    CardBounds given_bounds = bounds;
    given_bounds.has_near_blocks = near.has_blocks;
    void* arguments[] = {&given, &given_bounds};
    program(variant).kernel.launch(static_cast<unsigned>(count), static_cast<unsigned>(threads(variant)),
                                   near.bytes, arguments, stream_);
  }
  void finish() override {
    card_.use();
    stream_.synchronize();
  }

 private:
  // Shared memory of a block, besides what the program has: motions, and inverse own blocks if there is room.
  struct Shared {
    std::size_t bytes;
    bool has_blocks;
  };
  Shared shared(unsigned variant, std::size_t particles) const {
    const std::size_t motions = particles * sizeof(CardMotion),
                      blocks = particles * block_entries * sizeof(float);
    const bool has_blocks = motions + blocks <= program(variant).room;
    return {motions + (has_blocks ? blocks : 0), has_blocks};
  }

  int threads(unsigned variant) const { return program(variant).kernel.threads_per_block(); }

  struct Program {
    Program(std::string_view ptx, std::size_t shared)
        : module(ptx),
          kernel(module.kernel("advance")),
          room(shared - static_cast<std::size_t>(kernel.shared_bytes())) {
      kernel.allow_shared(room);
    }
    CardModule module;
    CardKernel kernel;
    std::size_t room;  // for dynamic shared memory of a block [bytes]
  };
  std::string ptx(unsigned variant) const {
    if (programs_folder_.empty()) return std::string(card_ptx(variant));
    std::ifstream file(programs_folder_ + '/' + std::to_string(variant) + ".ptx");
    return {std::istreambuf_iterator<char>(file), {}};
  }
  // Loads the program of a variant when it is first needed.
  const Program& program(unsigned variant) const {
    card_.use();
    const std::lock_guard lock(of_programs_);
    if (!programs_[variant]) programs_[variant].emplace(ptx(variant), card_.shared_memory_per_block());
    return *programs_[variant];
  }

  struct Place {
    CardMemory& memory;
    std::size_t offset;
  };
  // Returns the buffer that an address lies in.
  Place place_of(const void* address) {
    const auto value = reinterpret_cast<std::uint64_t>(address);
    const std::lock_guard lock(mutex_);
    const auto next = memories_.upper_bound(value);
    if (next == memories_.begin()) throw std::logic_error("an address that is not on the card");
    const auto found = std::prev(next);
    return {found->second, static_cast<std::size_t>(value - found->first)};
  }

  Card card_;
  std::string programs_folder_;
  std::mutex mutex_;                              // of the next
  std::map<std::uint64_t, CardMemory> memories_;  // by their addresses
  CardStream stream_;
  mutable std::mutex of_programs_;
  mutable std::array<std::optional<Program>, count_of_card_variants> programs_;
};

}  // namespace

std::unique_ptr<CardDevice> cuda_card(int number, const std::string& programs) {
  return std::make_unique<CudaCard>(number, programs);
}

}  // namespace peclet::engine
