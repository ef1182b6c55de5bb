// The engines whose results a campaign has.
#pragma once

#include <cstdint>

#include "contract/json.h"
#include "runner/database/database.h"

namespace peclet::runner {

// The engine's row, new when it was never seen before; inside a Transaction of the caller. Throws ResultError
// when the provenance does not say what the engine is.
std::int64_t engine_row(Database& database, const Json& provenance);

}  // namespace peclet::runner
