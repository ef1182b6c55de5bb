// What somebody asks of a campaign whose database another process may own: one file in requests/, written
// durably by the verb and removed by the owner when it has carried it out.
#pragma once

#include <optional>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include "contract/key_table.h"
#include "runner/campaign/paths.h"
#include "runner/store/campaign_directory.h"

namespace peclet::runner {

// The campaign is that of its file from now on.
struct TakeOver {
  fs::path file;
  std::string sha256;  // of the text whose scenes the engine has been asked about
};
// Points are named as people name them: by label, or by digits of the hash.
struct Prioritise {
  std::vector<std::string> points;
  int priority = 0;
};
struct Cancel {
  std::vector<std::string> points;
  bool undo = false;
};
struct Retry {
  std::vector<std::string> points;  // none: all
  std::vector<int> seeds;           // none: all that were given up
};
using Wish = std::variant<TakeOver, Prioritise, Cancel, Retry>;

struct Request {
  std::string name;  // of the file, without .json: names are in order of time, and no two are equal
  Wish wish;
};

// Keys of a request, by its "verb".
const KindTables& request_keys();

// The file is no request that this program can read.
class RequestError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Writes the request durably, makes the folder when it is not there, and returns it with its name.
// Throws NoRoomError, std::system_error.
Request write_request(const CampaignDirectory& directory, const Wish& wish);

// Throws RequestError.
Request read_request(const fs::path& file);

fs::path request_file(const CampaignDirectory& directory, const std::string& name);

// The requests that wait, oldest first.
std::vector<fs::path> waiting_requests(const CampaignDirectory& directory);

// Gives a file that is no request a name under which it waits no longer, and says where it is now. Nothing:
// it may not be moved.
std::optional<fs::path> set_request_aside(const fs::path& file);

}  // namespace peclet::runner
