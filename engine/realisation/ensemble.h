// Ensemble advances many independent realisations side by side.
//
// Between add() and remove() a realisation belongs to the ensemble: its Simulation holds the state with which
// it was added. A result depends on scene and seed alone, whatever else the ensemble computes. One thread
// adds, advances and removes; functions that take no Simulation and change nothing may be called by any.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "contract/errors.h"
#include "engine/realisation/simulation.h"

namespace peclet::engine {

class Ensemble {
 public:
  virtual ~Ensemble() = default;

  // Returns kind and version of its kernels, on which results depend beside scene and seed, in 80 bytes at
  // most.
  virtual std::string name() const = 0;

  // Returns the largest number of realisations that it holds at once, of any scene.
  virtual std::size_t capacity() const = 0;
  // Returns how many realisations of this scene it holds at once; 0 if it cannot run the scene. It holds a
  // mixture of scenes if their shares, 1 / capacity(scene) of each realisation, add up to 1 at most.
  virtual std::size_t capacity(const Scene& scene) const = 0;
  // Returns how many jobs to have at once, so that packed spheres wait for a place and no place for packing.
  std::size_t jobs() const { return capacity() + capacity() / 8 + 1; }
  // Returns why it cannot run this scene, which `file` names in the message; nothing if it can.
  virtual std::optional<InputError> refusal(const Scene& scene, const std::string& file) const = 0;

  // Takes a realisation that has been started or loaded, and whose scene it can run.
  virtual void add(Simulation& simulation) = 0;

  struct Ended {
    Simulation* simulation;
    Ending ending;
  };
  // Advances all realisations for about this time. Returns those that have ended: they have been removed.
  // After an exception the ensemble may only be destroyed.
  virtual std::vector<Ended> advance(std::chrono::duration<double> time) = 0;

  // Brings the present state of a realisation into its Simulation, and takes it out. It may be added again.
  virtual void remove(Simulation& simulation) = 0;

  // Return the number of steps that a realisation has made, and its net strain.
  virtual std::uint64_t steps_made(const Simulation& simulation) const = 0;
  virtual double net_strain(const Simulation& simulation) const = 0;
};

// The maker of the steps: the processor; a card; a card if there is one, for scenes that it can run; or, for
// tests, the processor as a card, slowly.
enum class Device { processor, cuda, automatic, emulated };

// Returns the device that `text` names: "cuda" or "auto". Throws InputError, which names where it was asked.
Device device_named(const std::string& text, const std::string& asked);

// Returns the ensemble of a card, by its number; null for the processor, and if `automatic` finds no card.
// Throws InputError, which names where the device was asked for, if `cuda` finds none.
std::unique_ptr<Ensemble> make_ensemble(Device device, int number, const std::string& asked);

}  // namespace peclet::engine
