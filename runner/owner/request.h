// Request is what a verb asks of a campaign that another process may own: one file in requests/, written
// durably by the verb and removed by the owner once it is carried out.
#pragma once

#include <optional>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include "contract/key_table.h"
#include "runner/campaign/campaign.h"
#include "runner/campaign/paths.h"
#include "runner/store/campaign_directory.h"

namespace peclet::runner {

// Takes the campaign over from its file.
struct TakeOver {
  fs::path file;
  std::string sha256;  // hash_of() the campaign whose scenes the engine has checked
};
// Returns the hash of a campaign with the content of its scene's file.
std::string hash_of(const Campaign& campaign);

// In the following, points are named by label or by digits of the hash.
struct Prioritise {
  std::vector<std::string> points;
  int priority = 0;
};
struct Cancel {
  std::vector<std::string> points;
  bool undo = false;
};
struct Retry {
  std::vector<std::string> points;  // all if empty
  std::vector<int> seeds;           // all that were given up if empty
};
using Wish = std::variant<TakeOver, Prioritise, Cancel, Retry>;

struct Request {
  std::string name;  // file name without .json; names sort by time and are unique
  Wish wish;
};

// Returns the keys of a request, by its "verb".
const KindTables& request_keys();

// Thrown if a file is not a request that this program can read.
class RequestError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Writes the request durably and returns it with its name. Throws NoRoomError, std::system_error.
Request write_request(const CampaignDirectory& directory, const Wish& wish);

// Throws RequestError.
Request read_request(const fs::path& file);

fs::path request_file(const CampaignDirectory& directory, const std::string& name);

// Returns the waiting requests, oldest first.
std::vector<fs::path> waiting_requests(const CampaignDirectory& directory);

// Renames a file that is not a request, so that it no longer waits. Returns its new path, or nothing.
std::optional<fs::path> set_request_aside(const fs::path& file);

}  // namespace peclet::runner
