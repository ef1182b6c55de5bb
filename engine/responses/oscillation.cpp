#include "engine/responses/oscillation.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "engine/terms/drag.h"

namespace peclet::engine {
namespace {

struct Named {
  const char *name, *symbol, *unit;
};
constexpr std::array<Named, 5> quantities = {{{"storage_modulus", "G'", "stress"},
                                              {"loss_modulus", "G''", "stress"},
                                              {"dynamic_viscosity", "η' / η", "1"},
                                              {"third_storage_modulus", "G'_3", "stress"},
                                              {"third_loss_modulus", "G''_3", "stress"}}};

// The number of equal blocks into which a window of so many cycles is divided: a power of two, and at least a
// cycle a block. A window of fewer than four cycles has no blocks, because the test of its beginning compares
// quarters.
std::size_t blocks_of_cycles(std::uint64_t cycles) {
  const std::size_t blocks = std::bit_floor(std::min<std::uint64_t>(cycles, count_of_blocks));
  return blocks < count_of_quarters ? 0 : blocks;
}

std::vector<Quantity> oscillation_quantities(const Scene&, const Window&) {
  std::vector<Quantity> all;
  all.reserve(quantities.size());
  for (const auto& [name, symbol, unit] : quantities)
    all.push_back({.name = name, .symbol = symbol, .unit = unit});
  return all;
}

}  // namespace

Oscillation::Oscillation(const Scene& scene, const System& system, const Window& window)
    : Observable(interval_of(scene, oscillation(), window)),
      volume_(system.box.volume()),
      swing_(*scene.physics.flow.deformation().swing()),
      solvent_(scene.physics.viscosity * swing_.frequency),
      background_(solvent_ * (1 + stresslet(scene.volume_fraction, {.xy = 1}).xy)),
      steps_of_cycle_(
          static_cast<std::uint64_t>(std::llround(*scene.physics.flow.period() / window.timestep))),
      cycles_(window.steps / steps_of_cycle_),
      ahead_(scene.method == Method::implicit_steps ? 0.5 : 1.0) {
  means_.fill(BlockedMean::number_with_blocks(blocks_of_cycles(cycles_)));
}

void Oscillation::take_flux(const MomentumFlux& flux) {
  const double in_cycle = static_cast<double>(taken_ % steps_of_cycle_) + ahead_;
  const double phase = 2 * std::numbers::pi * in_cycle / static_cast<double>(steps_of_cycle_);
  const double part = 2 * flux.acted().*swing_.component /
                      (volume_ * swing_.amplitude * static_cast<double>(steps_of_cycle_));
  cycle_[0].storage += part * std::sin(phase);
  cycle_[0].loss += part * std::cos(phase);
  cycle_[1].storage += part * std::sin(3 * phase);
  cycle_[1].loss += part * std::cos(3 * phase);
  ++taken_;
  if (taken_ % steps_of_cycle_ == 0) end_cycle();
}

std::size_t Oscillation::block_of_cycle() const {
  return static_cast<std::size_t>((taken_ / steps_of_cycle_ - 1) * count_of_blocks / cycles_);
}

void Oscillation::end_cycle() {
  const double loss = background_ + cycle_[0].loss;
  const std::array<double, 5> values = {cycle_[0].storage, loss, loss / solvent_, cycle_[1].storage,
                                        cycle_[1].loss};
  for (std::size_t k = 0; k < means_.size(); ++k) {
    means_[k].add(block_of_cycle(), 0, values[k]);
    means_[k].weigh(block_of_cycle(), 1);
  }
  cycle_ = {};
}

void Oscillation::add_to(Json& mean) const {
  for (std::size_t k = 0; k < means_.size(); ++k) mean[quantities[k].name] = means_[k].value();
}

void Oscillation::add_blocks_to(Json& blocks) const {
  if (blocks_of_cycles(cycles_) == 0) return;
  for (std::size_t k = 0; k < means_.size(); ++k) blocks[quantities[k].name] = means_[k].blocks();
}

void Oscillation::save(ArchiveWriter& archive) const {
  archive.put(taken_);
  archive.put(cycle_);
  for (const BlockedMean& mean : means_) mean.save(archive);
}

void Oscillation::load(ArchiveReader& archive) {
  taken_ = archive.get<std::uint64_t>();
  cycle_ = archive.get<std::array<Modulus, 2>>();
  for (BlockedMean& mean : means_) mean.load(archive);
}

ObservableKind oscillation() {
  return {"oscillation", every_step, [](const Scene&, const Window&, const std::string&) {},
          oscillation_quantities,
          [](const Scene& scene, const System& system, const Window& window) -> std::unique_ptr<Observable> {
            return std::make_unique<Oscillation>(scene, system, window);
          }};
}

}  // namespace peclet::engine
