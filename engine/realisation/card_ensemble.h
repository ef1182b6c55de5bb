// CardEnsemble advances realisations on a card, or on the processor that emulates one.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "engine/card/card_device.h"
#include "engine/realisation/ensemble.h"

namespace peclet::engine {

class CardEnsemble final : public Ensemble {
 public:
  explicit CardEnsemble(std::unique_ptr<CardDevice> device);
  ~CardEnsemble() override;

  // Lets a call of advance() make at most this many steps of each realisation.
  void limit_steps(std::uint64_t steps) { most_steps_ = steps; }
  // Gives slots this room at first, so that tests see them grow.
  void begin_with_room(const CardRoom& room) { first_room_ = room; }

  std::string name() const override { return device_->name(); }
  std::size_t capacity() const override;
  std::size_t capacity(const Scene& scene) const override;
  std::optional<InputError> refusal(const Scene& scene, const std::string& file) const override;
  void add(Simulation& simulation) override;
  std::vector<Ended> advance(std::chrono::duration<double> time) override;
  void remove(Simulation& simulation) override;
  std::uint64_t steps_made(const Simulation& simulation) const override;
  double net_strain(const Simulation& simulation) const override { return progress(simulation).strain; }
  // Returns the progress of a realisation at the end of the last advance().
  const CardProgress& progress(const Simulation& simulation) const;

 private:
  class OwnedMemory;
  struct LoadedScene;
  struct Slot;

  std::shared_ptr<LoadedScene> load(const Simulation& simulation);
  void place(Slot& slot);
  void bring_home(Slot& slot);
  // Gives a slot room, or compares its last step with half steps, if it waits for that.
  void settle(Slot& slot);
  // Does what the host has to do for a slot; returns the ending if it has one.
  std::optional<Ending> serve(Slot& slot);
  void serve_all(const std::vector<Slot*>& slots, std::vector<Ended>& ended);
  Slot& slot_of(const Simulation& simulation);

  std::unique_ptr<CardDevice> device_;
  std::uint64_t most_steps_;
  std::optional<CardRoom> first_room_;
  std::map<std::string, std::weak_ptr<LoadedScene>> scenes_;  // by motion and schedule
  std::vector<std::unique_ptr<Slot>> slots_;
};

}  // namespace peclet::engine
