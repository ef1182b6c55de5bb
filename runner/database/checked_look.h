// A stored look beside what the stored results say.
#pragma once

#include <optional>

#include "runner/database/database.h"

namespace peclet::runner {

// The last look at a point for the present target, checked by replaying it; nothing before the first. Throws
// IntegrityError when stored looks are not what the stored results say.
std::optional<Look> checked_look(Database& database, const PointRecord& point, const TargetRecord& target);

}  // namespace peclet::runner
