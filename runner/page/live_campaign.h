// A campaign as the live page shows it: read again when its database has changed and somebody asks, and told
// only as far as it has changed.
//
// Not for several threads.
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

// Whether a database may have changed since somebody looked, without opening it.
//
// Of the database and its write-ahead log: which files they are, their sizes and when they were last written;
// and who owns the campaign. Every commit writes one of the two.
struct DatabaseStamp {
  struct File {
    std::uint64_t device = 0, number = 0;
    std::int64_t bytes = 0, seconds = 0, nanoseconds = 0;
    friend bool operator==(const File&, const File&) = default;
  };
  File database, log;  // zeros while there is none
  std::optional<std::int64_t> owner;
  friend bool operator==(const DatabaseStamp&, const DatabaseStamp&) = default;

  // Whether it was written so short a time before `now` that the next commit might bear the same time: clocks
  // of file systems tick every few milliseconds.
  bool is_fresh(std::chrono::system_clock::time_point now) const;
};

DatabaseStamp stamp_of(const CampaignDirectory& directory);

class LiveCampaign {
 public:
  // `campaign` is a file or folder. Throws as open_campaign() when there is no campaign there; one that has
  // not been run yet is waited for.
  LiveCampaign(std::filesystem::path campaign, std::filesystem::path directory);

  // Looks whether there is something new, and reads it. Reading takes at most a tenth of the time, so that
  // what runs the campaign hardly notices. What goes wrong meanwhile is told, as "fault", beside what was
  // known.
  void refresh();

  // The whole page. Its document has "live": {"token", "program"}; before the first run it has "waiting",
  // what is waited for, in the place of points.
  std::shared_ptr<const std::string> page();
  // What has changed since the token: {"live", "head": the document without points, "count", "points": those
  // that have changed, by their place}; of a token that is none of this process, or a much older one,
  // everything. Null: nothing.
  std::shared_ptr<const std::string> changes_since(const std::string& token);
  // point_details() of the point with this hash; null when there is none.
  std::shared_ptr<const std::string> details(const std::string& hash);

  const std::string& name() const { return name_; }
  // What `status --check` would leave with.
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
  // `set_up`: how far its setting up is; "" before the first run.
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
  bool doubtful_ = false;         // whether it may have changed although the stamp has not
  Clock::time_point next_{};      // when it may be read again
  Clock::time_point detailed_{};  // when details may be read again
  std::string process_;           // a word that no other process of this kind has
  int revision_ = 0;
  Part head_;
  std::vector<Part> points_;
  Text page_;
  std::map<int, Text> changes_;             // by the revision since which; a bounded number
  std::map<std::string, Details> details_;  // by the point's hash; a bounded number
};

}  // namespace peclet::runner
