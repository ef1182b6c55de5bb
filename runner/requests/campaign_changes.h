// In words, what a campaign file changes in a campaign that has been run.
#pragma once

#include <string>

#include "runner/store/database.h"

namespace peclet::runner {

// "tolerance 5 % -> 3 %; 2 points added, 1 left out"; "nothing differs". Requires that the database holds a
// campaign and has not taken this one over yet.
std::string describe_changes(Database& database, const Campaign& campaign);

}  // namespace peclet::runner
