// How the threads of a run wait for each other.
#pragma once

namespace peclet::engine {

// libgomp's threads spin while they wait, for milliseconds as long as there are no more of them than
// processors. Where other work has the processors, a thread that spins takes the time of the one it waits
// for. This has them sleep much sooner, unless the environment says how they are to wait (OMP_WAIT_POLICY,
// GOMP_SPINCOUNT).
//
// libgomp reads the environment before main(), so this starts the program once more with the same process
// number, arguments and open files. Call it first of all. Where that cannot be done threads wait as libgomp
// has them: it costs time and changes no result.
void let_waiting_threads_sleep(char** arguments);

}  // namespace peclet::engine
