// Runs a team.
#pragma once

#include <vector>

#include "engine/threads/for_each_range.h"
#include "engine/threads/team.h"

namespace peclet::engine {

// Calls body(team) as each of the members of a team of that many threads. One thread never enters OpenMP.
template <class Body>
void run_team(int threads, Body&& body) {
  if (threads <= 1) {
    Team team;
    body(team);
    return;
  }
  std::vector<Team::Arrivals> arrivals(static_cast<std::size_t>(threads));
  in_parallel(threads, [&](std::size_t member, std::size_t members) {
    Team team({arrivals.data(), members}, member);
    body(team);
  });
}

}  // namespace peclet::engine
