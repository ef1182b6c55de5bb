// The observables of this room.
#pragma once

#include "engine/observables/kinds.h"

namespace peclet::engine {

ObservableKind stress_correlation();
ObservableKind linear_response();
ObservableKind oscillation();
ObservableKind transient();
ObservableKind flow_at_stress();

}  // namespace peclet::engine
