// CardDevice is a card, or the processor that emulates one: its memory, and the program that advances slots.
#pragma once

#include <memory>
#include <string>

#include "engine/card/card_variants.h"

namespace peclet::engine {

class CardDevice {
 public:
  virtual ~CardDevice() = default;

  // Returns what computes, as results say it.
  virtual std::string name() const = 0;
  // Returns how many realisations of this variant and number of particles fill it.
  virtual std::size_t places(unsigned variant, std::size_t particles) const = 0;

  // Memory of slots that do not advance may be used by any thread.
  virtual void* allocate(std::size_t bytes) = 0;
  virtual void release(void* memory) = 0;
  virtual void upload(void* to, const void* from, std::size_t bytes) = 0;
  virtual void download(void* to, const void* from, std::size_t bytes) = 0;

  // Begins to advance slots, an array in its memory. None has more than `particles`. finish() waits until all
  // slots that were begun have reached a bound.
  virtual void begin(unsigned variant, std::size_t particles, const CardSlot* slots, std::size_t count,
                     const CardBounds& bounds) = 0;
  virtual void finish() = 0;
};

// Returns the card of this number. `programs` is a folder with the PTX of each variant, 0.ptx and so on, to
// use in the place of what this program has. Throws CardError (cuda_driver.h).
std::unique_ptr<CardDevice> cuda_card(int number, const std::string& programs = {});
// Returns the processor as a card with this many places.
std::unique_ptr<CardDevice> emulated_card(std::size_t places);

}  // namespace peclet::engine
