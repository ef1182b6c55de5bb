#include "engine/realisation/driver.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "engine/terms/drag.h"
#include "engine/terms/keyed_random.h"

namespace peclet::engine {
namespace {

// Steps in the flow of the scene. Strains in both directions count as positive.
class GivenRate final : public Driver {
 public:
  explicit GivenRate(const ImposedFlow& flow) : flow_(flow) {}

  StepReport advance(Integrator& integrator, System& system, PairWatcher* watcher) override {
    integrator.show_pairs_to(watcher);
    return integrator.advance_open(system);
  }
  Strains strains(const System& system, const Schedule& schedule) const override {
    const std::uint64_t begin = std::min(system.step, schedule.equilibration);
    const Deformation& deformation = flow_.deformation();
    return {deformation.strain_between(schedule.timestep, 0, begin),
            deformation.strain_between(schedule.timestep, begin, system.step)};
  }

 private:
  ImposedFlow flow_;
};

// Relative error of the stress above which a step is repeated, and the largest number of attempts.
constexpr double tolerance = 0.01;
constexpr int most_attempts = 6;

// Response time of the rate: the usual and the shortest one [steps], and as a strain.
constexpr double usual_response = 20, shortest_response = 5, strain_of_response = 0.05;

// Returns the rate of the step that measures the slope with noise [1/time]. Its stress must be visible beside
// the stress of the noise, kT / a^3, which has single precision. At high stress it is the usual rate.
double trial_rate(const Scene& scene, double usual_rate) {
  const double a = scene.particles.reference_radius;
  return std::max(scene.physics.thermal_energy / (scene.physics.viscosity * a * a * a), usual_rate);
}

double time_of_response(double timestep, double usual_rate) {
  return std::clamp(strain_of_response / usual_rate, shortest_response * timestep, usual_response * timestep);
}

}  // namespace

std::unique_ptr<Driver> make_driver(Scene& scene, double timestep, std::uint64_t seed) {
  const ControlledShear* const given = scene.physics.flow.deformation().at_stress();
  if (given == nullptr) return std::make_unique<GivenRate>(scene.physics.flow);
  const auto own = std::make_shared<ControlledShear>(*given);
  scene.physics.flow = ImposedFlow(own);
  return std::make_unique<StressControl>(scene, own, timestep, seed);
}

StressControl::StressControl(const Scene& scene, std::shared_ptr<ControlledShear> shear, double timestep,
                             std::uint64_t seed)
    : shear_(std::move(shear)),
      timestep_(timestep),
      stress_(shear_->stress()),
      thermal_energy_(scene.physics.thermal_energy),
      trial_rate_(trial_rate(scene, shear_->largest_rate())),
      response_(time_of_response(timestep, shear_->largest_rate())),
      solvent_(scene.physics.viscosity * (1 + stresslet(scene.volume_fraction, {.xy = 1}).xy)),
      seed_(seed),
      rate_(shear_->present_rate()),
      slope_(stress_ / shear_->largest_rate()) {}

StepReport StressControl::advance(Integrator& integrator, System& system, PairWatcher* watcher) {
  const StepReport report = thermal_energy_ > 0 ? advance_with_inertia(integrator, system, watcher)
                                                : advance_to_stress(integrator, system, watcher);
  shear_->go_on(system.clock.time(), system.box.strain(), rate_);
  return report;
}

StepReport StressControl::step(Integrator& integrator, System& system, double rate) {
  shear_->go_on(system.clock.time(), system.box.strain(), rate);
  return integrator.advance(system);
}

double StressControl::stress_of_pairs(const StepReport& report, const System& system) const {
  double sum = 0;
  if (thermal_energy_ > 0) {
    sum = (total_stress(report.sums) + report.motion).xy;
  } else {
    for (const SymmetricTensor& term : report.sums.stress) sum += term.xy;
  }
  return sum / system.box.volume();
}

StepReport StressControl::advance_to_stress(Integrator& integrator, System& system, PairWatcher* watcher) {
  integrator.mark(system);
  const double fastest = stress_ / solvent_, largest_miss = tolerance * stress_;
  const double aim = stress_ + std::clamp(deficit_, -largest_miss, largest_miss);
  integrator.show_pairs_to(nullptr);
  double rate = rate_, stress = 0;
  StepReport report;
  for (int attempt = 1;; ++attempt) {
    const double last_rate = rate, last_stress = stress;
    if (attempt > 1) {
      rate = std::clamp(rate + (aim - stress) / slope_, -fastest, fastest);
      integrator.return_to_mark(system);
    }
    report = step(integrator, system, rate);
    if (report.broke_off || !report.sums.finite) break;
    stress = stress_of_pairs(report, system) + solvent_ * rate;
    if (attempt > 1 && rate != last_rate) {
      slope_ = std::max((stress - last_stress) / (rate - last_rate), solvent_);
    }
    if (std::abs(aim - stress) <= largest_miss || attempt == most_attempts) break;
  }
  if (watcher != nullptr) {
    integrator.return_to_mark(system);
    integrator.show_pairs_to(watcher);
    report = step(integrator, system, rate);
  }
  rate_ = rate;
  deficit_ += stress_ - stress;
  return report;
}

// Measures the slope of the pair stress by a step at rest and one at the trial rate, with the same noise. If
// one of them breaks off, the slope stays as it is.
void StressControl::find_inertia(Integrator& integrator, System& system) {
  integrator.mark(system);
  integrator.show_pairs_to(nullptr);
  const auto stress_at = [&](double rate) {
    const StepReport report = step(integrator, system, rate);
    const double stress = stress_of_pairs(report, system);
    integrator.return_to_mark(system);
    return report.broke_off || !report.sums.finite ? std::numeric_limits<double>::quiet_NaN() : stress;
  };
  const double slope = (stress_at(trial_rate_) - stress_at(0)) / trial_rate_;
  if (std::isfinite(slope)) slope_ = std::max(slope, 0.0);
  inertia_ = response_ * (slope_ + solvent_);
}

// Friction acts half at the old and half at the new rate; the slope gives the pair stress at the new rate.
StepReport StressControl::advance_with_inertia(Integrator& integrator, System& system, PairWatcher* watcher) {
  if (inertia_ == 0 || std::has_single_bit(system.step)) find_inertia(integrator, system);
  const double volume = system.box.volume();
  const NormalPair normals = KeyedRandom(seed_, Purpose::strain_noise).normals(system.step, 0);
  const double noise = std::sqrt(2 * thermal_energy_ * solvent_ / (volume * timestep_)) * normals.first.x;
  integrator.show_pairs_to(watcher);
  const StepReport report = step(integrator, system, rate_);
  const double missing = stress_ - stress_of_pairs(report, system) - solvent_ * rate_ + noise;
  rate_ += timestep_ * missing / (inertia_ + 0.5 * timestep_ * (slope_ + solvent_));
  return report;
}

bool StressControl::has_jammed(const System& system) {
  if (system.box.strain() - strain_waited_from_ >= ControlledShear::least_strain) wait_from(system);
  return system.clock.time() - time_waited_from_ >= shear_->patience();
}

void StressControl::wait_from(const System& system) {
  strain_waited_from_ = system.box.strain();
  time_waited_from_ = system.clock.time();
}

std::optional<Ending> StressControl::ending(const System& system, Schedule& schedule) {
  const bool jammed = has_jammed(system);
  if (system.step < schedule.equilibration && jammed) schedule.equilibration = system.step;
  if (system.step == schedule.equilibration) {
    begin_window(system);
    wait_from(system);
    return std::nullopt;
  }
  if (!jammed) return std::nullopt;
  return Ending{Ending::Cause::jammed, system.step,
                fmt::format("the suspension stands still under its stress: jammed at a strain of {:.4g}",
                            system.box.strain())};
}

Strains StressControl::strains(const System& system, const Schedule& schedule) const {
  const double strain = system.box.strain();
  const double before = system.step > schedule.equilibration ? strain_at_window_ : strain;
  return {before, strain - before};
}

void StressControl::save(ArchiveWriter& archive) const {
  archive.put_all(rate_, slope_, deficit_, inertia_, strain_waited_from_, time_waited_from_,
                  strain_at_window_);
}

void StressControl::load(const System& system, ArchiveReader& archive) {
  archive.get_all(rate_, slope_, deficit_, inertia_, strain_waited_from_, time_waited_from_,
                  strain_at_window_);
  shear_->go_on(system.clock.time(), system.box.strain(), rate_);
}

}  // namespace peclet::engine
