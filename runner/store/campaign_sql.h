// The texts of schema/*.sql.
#pragma once

namespace peclet::runner {

extern const char* const campaign_sql;  // the tables
extern const char* const views_sql;     // what people read

}  // namespace peclet::runner
