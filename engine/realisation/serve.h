// The engine as a worker: jobs come and results go over a socket.
#pragma once

namespace peclet::engine {

// Speaks frames on `descriptor` until the peer closes it or says stop; schema/README.md lists the messages.
// Returns the exit code.
int serve(int descriptor);

}  // namespace peclet::engine
