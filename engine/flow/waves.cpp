#include "engine/flow/waves.h"

namespace peclet::engine {

Keys wave_keys() {
  constexpr std::size_t most_waves = 64;
  return {
      {.pointer = "/flow/waves",
       .kind = KeyKind::array,
       .meaning =
           "Waves along y that the flow has besides: u_x = sum of sine sin(k y) + cosine cos(k y) with k "
           "= 2 pi periods / L.",
       .minimum_items = 1,
       .maximum_items = most_waves},
      block("/flow/waves/*", "One wave."),
      {.pointer = "/flow/waves/*/periods",
       .kind = KeyKind::integer,
       .meaning = "Periods of the wave along the edge of the box.",
       .required = true,
       .minimum = 1,
       .maximum = 1000},
      {.pointer = "/flow/waves/*/sine",
       .kind = KeyKind::number,
       .meaning = "Amplitude of the sine.",
       .unit = "length / time",
       .default_value = 0},
      {.pointer = "/flow/waves/*/cosine",
       .kind = KeyKind::number,
       .meaning = "Amplitude of the cosine.",
       .unit = "length / time",
       .default_value = 0},
      {.pointer = "/flow/faxen",
       .kind = KeyKind::boolean,
       .meaning =
           "Whether spheres feel the curvature of the waves: their velocity with the factor 1 - a^2 k^2 / "
           "6, the strain of their stresslet with 1 - a^2 k^2 / 10. Must be given with waves; without them "
           "nothing is curved."},
  };
}

std::shared_ptr<const FlowVariation> read_waves(const SceneDocument& scene) {
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
