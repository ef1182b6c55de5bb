// Runs the program for cards on the processor: the same source, one thread of a block after the other. It
// gives the bits of a card, and is slow.
#include <omp.h>

#include <array>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <new>
#include <utility>
#include <vector>

#include "engine/card/card_device.h"
#include "engine/state/threads.h"

namespace peclet::engine {
namespace {

using Advance = void (*)(const CardSlot& slot, CardNear& near, CardMotion* scaled, const CardTeam& team,
                         const CardBounds& bounds);

template <unsigned... numbers>
constexpr std::array<Advance, sizeof...(numbers)> every_variant(
    std::integer_sequence<unsigned, numbers...> /*numbers*/) {
  return {[](const CardSlot& slot, CardNear& near, CardMotion* scaled, const CardTeam& team,
             const CardBounds& bounds) { advance_slot<numbers>(slot, near, scaled, team, bounds); }...};
}

class EmulatedCard final : public CardDevice {
 public:
  explicit EmulatedCard(std::size_t places) : places_(places) {}

  std::string name() const override { return "emulated"; }
  std::size_t places(unsigned /*variant*/, std::size_t /*particles*/) const override { return places_; }

  void* allocate(std::size_t bytes) override {
    constexpr std::size_t alignment = 256;
    void* const memory = std::aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment);
    if (memory == nullptr) throw std::bad_alloc();
    return memory;
  }
  void release(void* memory) override { std::free(memory); }
  void upload(void* to, const void* from, std::size_t bytes) override { std::memcpy(to, from, bytes); }
  void download(void* to, const void* from, std::size_t bytes) override { std::memcpy(to, from, bytes); }

  void begin(unsigned variant, std::size_t /*particles*/, const CardSlot* slots, std::size_t count,
             const CardBounds& bounds) override {
    constexpr auto advance = every_variant(std::make_integer_sequence<unsigned, count_of_card_variants>{});
    for_each_index(count, omp_get_num_procs(), [&](std::size_t k) {
      const auto near = std::make_unique<CardNear>();
      std::vector<CardMotion> scaled(slots[k].scene->particles);
      advance[variant](slots[k], *near, scaled.data(), CardTeam(), bounds);
    });
  }
  void finish() override {}

 private:
  std::size_t places_;
};

}  // namespace

std::unique_ptr<CardDevice> emulated_card(std::size_t places) {
  return std::make_unique<EmulatedCard>(places);
}

}  // namespace peclet::engine
