// Works for a runner: receives jobs and reports results over a socket.
#pragma once

#include "engine/realisation/ensemble.h"

namespace peclet::engine {

// Answers frames (schema/README.md) until the peer leaves or sends drain or stop. Returns the exit code. With
// an ensemble it takes as many jobs at once as this holds, and one more; the device is as for Crew.
int serve(int descriptor, Ensemble* ensemble = nullptr, Device device = Device::automatic);

}  // namespace peclet::engine
