// The text of schema/campaign.sql.
#pragma once

namespace peclet::runner {

extern const char* const campaign_sql;

}  // namespace peclet::runner
