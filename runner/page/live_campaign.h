// The document of a campaign's live page, read again when the database has changed, and the changes that an
// open page has not seen. Not thread-safe.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "contract/json.h"
#include "runner/page/page_data.h"
#include "runner/store/campaign_directory.h"

namespace peclet::runner {

// The identity, size and last change of a database and its write-ahead log, and the owner of the campaign.
// Every commit writes one of the two files, so a changed stamp tells of it without opening the database.
struct DatabaseStamp {
  struct File {
    std::uint64_t device = 0, number = 0;
    std::int64_t bytes = 0, seconds = 0, nanoseconds = 0;
    friend bool operator==(const File&, const File&) = default;
  };
  File database, log;  // zeros if there is no file
  std::optional<std::int64_t> owner;
  friend bool operator==(const DatabaseStamp&, const DatabaseStamp&) = default;

  // True if a file was written less than 0.1 s before `now`. The next commit might then have the same time,
  // because clocks of file systems tick every few milliseconds.
  bool is_fresh(std::chrono::system_clock::time_point now) const;
};

DatabaseStamp stamp_of(const CampaignDirectory& directory);

class LiveCampaign {
 public:
  // `campaign` is a file or folder. A campaign that has not been run yet is shown as waiting. Throws as
  // open_campaign() if the campaign does not exist.
  LiveCampaign(std::filesystem::path campaign, std::filesystem::path directory);

  // Reads the campaign again if it may have changed. Reading takes at most a tenth of the time, so that it
  // hardly slows the campaign. If it fails, the old document gets the message as "fault".
  void refresh();

  // Returns the whole page. Its document has "live": {"token", "program"}. Before the first run it has the
  // sentence "waiting" in the place of points.
  std::shared_ptr<const std::string> page();
  // Returns the changes since the token, null if there are none: {"live", "head": the document without
  // points, "count", "points": those that have changed, by their place}. An unknown token gets everything.
  std::shared_ptr<const std::string> changes_since(const std::string& token);
  // Returns point_details() of the point with this hash, null if it does not exist.
  std::shared_ptr<const std::string> details(const std::string& hash);

  const std::string& name() const { return name_; }
  // Returns the exit code of `status --check`.
  int exit_code() const { return exit_code_; }

 private:
  using Clock = std::chrono::steady_clock;
  using Text = std::shared_ptr<const std::string>;
  struct Part {
    Json json;
    std::string text;
    int revision = 0;  // of its last change
  };
  struct Details {
    std::string key;
    Text text;
  };

  void read();
  // Shows that there are no results yet. `set_up` says how far the first run is; "" before it.
  void wait_for_beginning(const std::string& set_up = "");
  void become(Json document);
  void tell(const std::string& fault);
  void advance_to(int revision);
  Json live() const;

  std::filesystem::path campaign_, directory_;
  std::string name_;
  int exit_code_ = 0;
  PageReader reader_;
  std::optional<DatabaseStamp> stamp_;
  bool doubtful_ = false;         // the campaign may have changed although the stamp has not
  Clock::time_point next_{};      // when it may be read again
  Clock::time_point detailed_{};  // when details may be read again
  std::string process_;           // unique to this process
  int revision_ = 0;
  Part head_;
  std::vector<Part> points_;
  Text page_;
  std::map<int, Text> changes_;             // by the revision before them; a bounded number
  std::map<std::string, Details> details_;  // by the point's hash; a bounded number
};

}  // namespace peclet::runner
