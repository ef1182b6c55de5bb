#include "engine/observables/stress_profile.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "engine/kernels/pairs/terms.h"
#include "engine/terms/drag.h"

namespace peclet::engine {
namespace {

// Calls `visit` with each bin that the line from y to y + way crosses and the part of the line within it.
template <class Visit>
void share_line(double y, double way, double width, std::size_t bins, Visit&& visit) {
  const double low = std::min(y, y + way) / width, high = std::max(y, y + way) / width;
  const auto first = static_cast<std::int64_t>(std::floor(low));
  const auto last = std::max(first, static_cast<std::int64_t>(std::ceil(high)) - 1);
  for (std::int64_t k = first; k <= last; ++k) {
    const auto bottom = static_cast<double>(k);
    const double part =
        first == last ? 1 : (std::min(high, bottom + 1) - std::max(low, bottom)) / (high - low);
    visit(periodic_bin(k, bins), part);
  }
}

}  // namespace

StressProfile::StressProfile(const Physics& physics, std::size_t bins)
    : physics_(physics),
      terms_(terms(physics)),
      unit_(unit_of_stress(physics)),
      bins_(bins),
      step_stress_(terms_.size() * bins),
      step_flux_(bins),
      step_drag_(bins),
      by_term_(terms_.size()) {
  for_each(*this, [&](BlockedMean& mean) { mean = BlockedMean(bins); });
}

const Json& StressProfile::stress_components() {
  static const Json names = {"xx", "yy", "zz", "xy"};
  return names;
}

const Json& StressProfile::flux_components() {
  static const Json names = {"xy", "yy", "zy"};
  return names;
}

std::vector<StressTerm> StressProfile::terms(const Physics& physics) {
  std::vector<StressTerm> present;
  for (std::size_t t = 0; t < count_of_stress_terms; ++t) {
    const auto term = static_cast<StressTerm>(t);
    if (has_stress_term(physics, term)) present.push_back(term);
  }
  return present;
}

void StressProfile::begin(const System& system, double weight) {
  const Vector3 lengths = system.box.lengths();
  width_ = lengths.y / static_cast<double>(bins_);
  area_ = lengths.x * lengths.z;
  weight_ = weight;
  if (has_balance(physics_)) add_drag(system);
}

void StressProfile::add_drag(const System& system) {
  const ParticleState& particles = system.particles;
  const BackgroundFlow flow = physics_.flow.at(system.box);
  for (std::size_t i = 0; i < particles.count(); ++i) {
    const double a = particles.radius[i];
    const Vector3 x = particles.position[i];
    const Vector3 drag = (weight_ * translational_drag(physics_.viscosity, a) / area_) *
                         (flow.velocity(x, a) - particles.velocity[i]);
    // Between the boundaries below and above.
    const double place = x.y / width_, bottom = std::floor(place);
    const std::size_t below = periodic_bin(static_cast<std::int64_t>(bottom), bins_);
    step_drag_[below] += (1 - (place - bottom)) * drag;
    step_drag_[(below + 1) % bins_] += (place - bottom) * drag;
  }
}

void StressProfile::take(const System& system, const Pair& pair, const PairSums& sums, const Vector3& force) {
  const ParticleState& particles = system.particles;
  const Vector3 first = particles.position[pair.first];
  const Vector3 way =
      particles.position[pair.second] - first + system.box.displacement(system.list.images()[pair.image]);
  const double of_bin = weight_ / (area_ * width_);
  share_line(first.y, way.y, width_, bins_, [&](std::size_t bin, double part) {
    for (std::size_t t = 0; t < terms_.size(); ++t)
      step_stress_[t * bins_ + bin] += (part * of_bin) * sums.of(terms_[t]);
    step_flux_[bin] += (part * of_bin * way.y) * force;
  });
}

void StressProfile::add_step(std::size_t block) {
  const auto add = [&](BlockedMean& mean, std::size_t bin, double value) {
    mean.add(block, bin, value / unit_);
  };
  const auto add_stress = [&](Rows<count_of_stress_components>& rows, std::size_t bin,
                              const SymmetricTensor& stress) {
    add(rows[0], bin, stress.xx);
    add(rows[1], bin, stress.yy);
    add(rows[2], bin, stress.zz);
    add(rows[3], bin, stress.xy);
  };
  const auto add_vector = [&](Rows<count_of_flux_components>& rows, std::size_t bin, const Vector3& vector) {
    add(rows[0], bin, vector.x);
    add(rows[1], bin, vector.y);
    add(rows[2], bin, vector.z);
  };
  for (std::size_t bin = 0; bin < bins_; ++bin) {
    SymmetricTensor total;
    for (std::size_t t = 0; t < terms_.size(); ++t) {
      const SymmetricTensor& own = step_stress_[t * bins_ + bin];
      add_stress(by_term_[t], bin, own);
      total += own;
    }
    add_stress(stress_, bin, total);
    add_vector(flux_, bin, step_flux_[bin]);
    add_vector(drag_, bin, step_drag_[bin]);
  }
  for_each(*this, [&](BlockedMean& mean) { mean.weigh(block, 1); });
  std::ranges::fill(step_stress_, SymmetricTensor{});
  std::ranges::fill(step_flux_, Vector3{});
  std::ranges::fill(step_drag_, Vector3{});
}

Json StressProfile::imbalance() const {
  double left = 0, largest = 0;
  for (std::size_t c = 0; c < count_of_flux_components; ++c) {
    const Json flux = flux_[c].value(), drag = drag_[c].value();
    for (std::size_t k = 0; k < bins_; ++k) {
      const double here = flux[k], before = flux[(k + bins_ - 1) % bins_];
      left = std::max(left, std::abs(here - before + drag[k].get<double>()));
      largest = std::max(largest, std::abs(here));
    }
  }
  return largest > 0 ? Json(left / largest) : Json();
}

void StressProfile::add_to(Json& profiles) const {
  profiles["stress"]["pairs"] = values_of(stress_);
  for (std::size_t t = 0; t < terms_.size(); ++t)
    profiles["stress"][name_of(terms_[t])] = values_of(by_term_[t]);
  if (!has_balance(physics_)) return;
  profiles["momentum_flux"] = values_of(flux_);
  profiles["drag"] = values_of(drag_);
  profiles["momentum_imbalance"] = imbalance();
}

void StressProfile::add_blocks_to(Json& profiles) const {
  profiles["stress"]["pairs"] = blocks_of(stress_);
  if (!has_balance(physics_)) return;
  profiles["momentum_flux"] = blocks_of(flux_);
  profiles["drag"] = blocks_of(drag_);
}

template <class Self, class Function>
void StressProfile::for_each(Self& self, Function&& function) {
  for (auto& mean : self.stress_) function(mean);
  for (auto& rows : self.by_term_) {
    for (auto& mean : rows) function(mean);
  }
  for (auto& mean : self.flux_) function(mean);
  for (auto& mean : self.drag_) function(mean);
}

void StressProfile::save(ArchiveWriter& archive) const {
  for_each(*this, [&](const BlockedMean& mean) { mean.save(archive); });
}

void StressProfile::load(ArchiveReader& archive) {
  for_each(*this, [&](BlockedMean& mean) { mean.load(archive); });
}

}  // namespace peclet::engine
