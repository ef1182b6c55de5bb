// Whether a campaign's database has the tables that this program makes.
#pragma once

#include "runner/database/sqlite.h"

namespace peclet::runner {

// A file that calls itself a campaign's database may have been made by anybody: where a table should be there
// may be a view that never ends, and a trigger may write what nobody asked for. Nothing of such a file is
// read. Requires that its kind and version are known. Throws IntegrityError.
void check_tables(Connection& connection);

}  // namespace peclet::runner
