// The observables of this room.
#pragma once

#include "engine/observables/kinds.h"

namespace peclet::engine {

ObservableKind stress_correlation();
ObservableKind linear_response();
ObservableKind oscillation();
ObservableKind transient();

}  // namespace peclet::engine
