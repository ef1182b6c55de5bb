// Which laws of pairs a scene has.
#pragma once

#include "engine/terms/laws.h"

namespace peclet::engine {

struct Physics;

// The terms that this physics asks for.
Terms required_terms(const Physics& physics);

// Whether this physics has that part of the stress.
bool has_stress_term(const Physics& physics, StressTerm term);

}  // namespace peclet::engine
