// What a reader finds first in a supplement.
#pragma once

#include <string>

#include "runner/reports/status.h"

namespace peclet::runner {

// README.md: the table of results, what each file is, which number is the one, how to check and to redo it.
std::string supplement_readme(const CampaignStatus& status);

}  // namespace peclet::runner
