// The block particles of a scene, and the volume fraction that may follow from it.
#pragma once

#include "engine/flow/scene_document.h"
#include "engine/scene/composition.h"

namespace peclet::engine {

// Of /particles, /volume_fraction and /addition.
std::string particle_keys();

// Sizes with their shares, densities and the radius of reference. Throws InputError where they do not go
// together.
Particles read_particles(const SceneDocument& scene);

// As given, or with /addition that of the mixture in which the liquid and the other group stay what they were
// at the base volume fraction phi_0: phi_0 / (phi_0 + (1 - phi_0) s), s the share of that other group among
// the spheres. Throws InputError where it is too large.
double read_volume_fraction(const SceneDocument& scene, const Particles& particles);

}  // namespace peclet::engine
