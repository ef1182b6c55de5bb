// Configuration is a state to evaluate: positions, velocities, springs and random vectors as given.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "contract/json.h"
#include "contract/key_table.h"
#include "engine/scene/scene.h"
#include "engine/state/contact_history.h"
#include "engine/terms/keyed_random.h"

namespace peclet::engine {

struct GivenPairNoise {
  std::uint32_t first, second;
  LatticeShift image;
  NormalPair normals;  // theta, chi
};

struct GivenNoise {
  double timestep = 0;
  VectorField force, torque;  // unit normal vectors psi and phi of each particle
  std::vector<GivenPairNoise> pairs;
};

struct Configuration {
  Physics physics;
  ParticleState particles;  // have the density 1, because masses do not enter forces
  PeriodicCell box;
  std::vector<HeldContact> springs;  // `image` is added to the given position of the second particle
  std::optional<GivenNoise> noise;
  std::optional<double> advance;  // time by which springs are advanced
};

const KeyTable& configuration_keys();

// Reads a configuration. Throws InputError if keys or values have faults.
Configuration read_configuration(const Json& document, const std::string& file);

// Returns forces, torques and stress by term, and the advanced springs if `advance` is set. schema/README.md
// describes both documents. Throws std::invalid_argument if a particle interacts with its own image.
Json evaluate_configuration(const Configuration& configuration);

}  // namespace peclet::engine
