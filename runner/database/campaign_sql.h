// The texts of schema/*.sql.
#pragma once

namespace peclet::runner {

extern const char* const campaign_sql;   // the tables, newest version
extern const char* const views_sql;      // what people read
extern const char* const version_2_sql;  // from version 1 of the tables
extern const char* const version_3_sql;  // from version 2
extern const char* const version_4_sql;  // from version 3
extern const char* const version_5_sql;  // from version 4
extern const char* const version_6_sql;  // from version 5
extern const char* const version_7_sql;  // from version 6

}  // namespace peclet::runner
