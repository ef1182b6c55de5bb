// All that the page of a campaign shows, as one JSON document.
//
// It is made of aggregates: whatever the number of seeds, a point takes some kilobytes, and only some of its
// results are read.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "contract/json.h"
#include "runner/page/page_parts.h"
#include "runner/store/database.h"

namespace peclet::runner {

// Reads one campaign again and again, and of its points only those anew that have changed.
class PageReader {
 public:
  // `whole`: with the details of every point and the hash of the results, which take seconds in a large
  // campaign. `owner`: the process that runs it now. Throws IntegrityError when stored looks are not what the
  // stored results say.
  Json read(Database& database, std::optional<std::int64_t> owner, bool whole);

  // Of a point that was there when it was last read, by its hash: a word that changes when its results do,
  // and point_details() of it.
  std::optional<std::string> key(const std::string& hash) const;
  Json details(Database& database, const std::string& hash) const;

 private:
  const PointSummary* find(const std::string& hash) const;

  CampaignStatus status_;
  KnownPoints known_;
};

// The whole of it. Without an owner it depends on the database alone.
Json page_data(Database& database, std::optional<std::int64_t> owner);

}  // namespace peclet::runner
