// From the tables of an older version to those of this program.
#pragma once

#include <cstdint>

#include "runner/database/sqlite.h"

namespace peclet::runner {

// Copies the database to PATH.version-N first (whole or not at all; an older copy of that name is kept,
// because it was made before the first attempt), then changes it in one transaction: killed at any moment, it
// is of either version. Requires the campaign's lock and a sound database of version `from`. Throws
// DatabaseError.
void migrate(Connection& connection, std::int64_t from);

}  // namespace peclet::runner
