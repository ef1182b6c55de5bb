// All that the page of a campaign shows, as one JSON document ("Page" in schema/README.md).
//
// It is made of aggregates: whatever the number of seeds, a point takes some kilobytes, and no result is read
// but the first one of each point, for its dimensionless groups and warnings.
#pragma once

#include <cstdint>
#include <optional>

#include "contract/json.h"
#include "runner/database/database.h"

namespace peclet::runner {

// `owner`: the process that runs it now. Without one it depends on the database alone. Throws IntegrityError
// when stored looks are not what the stored results say.
Json page_data(Database& database, std::optional<std::int64_t> owner);

}  // namespace peclet::runner
