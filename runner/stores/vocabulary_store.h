// What the engine of a campaign calls the keys of its scenes and the numbers that follow from them.
#pragma once

#include "runner/database/database.h"
#include "runner/engines/vocabulary.h"

namespace peclet::runner {

// Replaces what an earlier engine has said; within a Transaction of its own.
void keep_vocabulary(Database& database, const Vocabulary& vocabulary);

// Knows no names in a campaign that no engine has spoken for.
Vocabulary kept_vocabulary(Database& database);

}  // namespace peclet::runner
