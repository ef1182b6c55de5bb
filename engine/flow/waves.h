// Waves adds waves along y to the flow, as in Monti, Rathee, Shen & Rosti (2021), Phys. Fluids 33, 103314:
//   u'_x(y) = sum over waves of S sin(k y) + C cos(k y),   k = 2 pi periods / Ly.
// S and C are amplitudes [length/time]. Ly is the height of the cell above its first lattice vector, which
// simple shear along x does not change. Waves are eigenfunctions of the Laplacian: (1 + a^2/6 lap) multiplies
// their velocity by 1 - a^2 k^2 / 6, and (1 + a^2/10 lap) their gradient by 1 - a^2 k^2 / 10, for a sphere of
// radius a. Powers of sines are sums of such waves: sin^3 t = (3 sin t - sin 3 t) / 4.
#pragma once

#include <cmath>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include "engine/flow/background_flow.h"
#include "engine/flow/scene_document.h"

namespace peclet::engine {

struct Wave {
  int periods = 1;              // number in the height of the cell
  double sine = 0, cosine = 0;  // amplitudes S and C [length/time]
};

class Waves final : public FlowVariation {
 public:
  // `faxen`: spheres feel the curvature of the flow.
  Waves(std::vector<Wave> waves, bool faxen) : waves_(std::move(waves)), faxen_(faxen) {}

  Local at(const Vector3& x, const PeriodicCell& cell) const override {
    double velocity = 0, gradient = 0, laplacian = 0, laplacian_of_gradient = 0;
    for (const Wave& wave : waves_) {
      const double k = wavenumber(wave, cell);
      const double sine = std::sin(k * x.y), cosine = std::cos(k * x.y);
      const double u = wave.sine * sine + wave.cosine * cosine;
      const double slope = k * (wave.sine * cosine - wave.cosine * sine);
      velocity += u;
      gradient += slope;
      laplacian -= k * k * u;
      laplacian_of_gradient -= k * k * slope;
    }
    Local local{.velocity = {velocity, 0, 0},
                .laplacian = {},
                .gradient = simple_shear(gradient),
                .laplacian_of_gradient = {}};
    if (faxen_) {
      local.laplacian = {laplacian, 0, 0};
      local.laplacian_of_gradient = simple_shear(laplacian_of_gradient);
    }
    return local;
  }

  double largest_rate(const PeriodicCell& cell) const override {
    double sum = 0;
    for (const Wave& wave : waves_) sum += wavenumber(wave, cell) * std::hypot(wave.sine, wave.cosine);
    return sum;
  }

 private:
  static double wavenumber(const Wave& wave, const PeriodicCell& cell) {
    return 2 * std::numbers::pi * wave.periods / cell.edges().column[1].y;
  }

  std::vector<Wave> waves_;
  bool faxen_;
};

inline constexpr const char* wave_keys = R"(
/flow/waves? | array of 1 to 64 | Waves along y that are added to the flow: u_x = sum of sine sin(k y) +
    cosine cos(k y) with k = 2 pi periods / L.
/flow/waves/* | object
/flow/waves/*/periods | integer >= 1 and <= 1000 | Periods of the wave along the edge of the box.
/flow/waves/*/sine | number; in length / time; default 0 | Amplitude of the sine.
/flow/waves/*/cosine | number; in length / time; default 0 | Amplitude of the cosine.
/flow/faxen? | true or false | Whether spheres feel the curvature of the waves: their velocity with the factor
    1 - a^2 k^2 / 6, the strain of their stresslet with 1 - a^2 k^2 / 10. Required with waves; without them it
    has no effect.
)";
// Returns the waves of the scene; null if it has none. Throws InputError if /flow/faxen is missing.
inline std::shared_ptr<const FlowVariation> read_waves(const SceneDocument& scene) {
  if (!scene.has("/flow/waves")) return nullptr;
  if (!scene.has("/flow/faxen"))
    scene.miss("/flow/faxen", "must be true or false where there are /flow/waves");
  std::vector<Wave> waves;
  for (const Json& wave : scene.at("/flow/waves")) {
    const double sine = wave.at("sine").get<double>(), cosine = wave.at("cosine").get<double>();
    if (sine != 0 || cosine != 0) waves.push_back({wave.at("periods").get<int>(), sine, cosine});
  }
  if (waves.empty()) return nullptr;
  return std::make_shared<Waves>(std::move(waves), scene.at("/flow/faxen").get<bool>());
}

}  // namespace peclet::engine
