#include "engine/flow/waves.h"

namespace peclet::engine {

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
