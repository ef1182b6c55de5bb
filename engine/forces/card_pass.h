// Evaluates the pairs of a configuration by the kernels for cards, which the processor emulates.
#pragma once

#include <optional>

#include "contract/errors.h"
#include "engine/kernels/pair_pass.h"

namespace peclet::engine {

// Returns why the kernels cannot do that, if they cannot.
std::optional<InputError> refusal_by_card(const Physics& physics, const NeighbourList& list);

// Does what PairPass(terms, ...).evaluate() does with given noise. Of the sums it sets the stress.
PairSums evaluate_as_card(const Physics& physics, const Terms& terms, const PairPassInput& input,
                          SpringField& springs, VectorField& force, VectorField& torque);

}  // namespace peclet::engine
