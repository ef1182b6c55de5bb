#include "runner/page/live_campaign.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <charconv>
#include <utility>

#include "contract/errors.h"
#include "contract/text.h"
#include "runner/campaign/campaign.h"
#include "runner/campaign/campaign_file.h"
#include "runner/owner/open_campaign.h"
#include "runner/page/page_html.h"
#include "runner/store/database.h"
#include "runner/store/locks.h"

namespace peclet::runner {
namespace {

// Uses stat() only: closing another descriptor of the file would drop SQLite's locks.
DatabaseStamp::File file_stamp(const std::string& path) {
  struct stat about {};
  if (stat(path.c_str(), &about) != 0) return {};
  return {about.st_dev, about.st_ino, about.st_size, about.st_mtim.tv_sec, about.st_mtim.tv_nsec};
}

bool was_written_after(const DatabaseStamp::File& file, std::chrono::system_clock::time_point time) {
  const auto written = std::chrono::seconds(file.seconds) + std::chrono::nanoseconds(file.nanoseconds);
  return file.number != 0 && written > time.time_since_epoch();
}

}  // namespace

bool DatabaseStamp::is_fresh(std::chrono::system_clock::time_point now) const {
  const auto just_now = now - std::chrono::milliseconds(100);
  return was_written_after(database, just_now) || was_written_after(log, just_now);
}

DatabaseStamp stamp_of(const CampaignDirectory& directory) {
  const std::string database = directory.database().string();
  return {file_stamp(database), file_stamp(database + "-wal"), current_owner(directory)};
}

namespace {

namespace fs = std::filesystem;

// Revisions by which a page may be behind and still get only the changes.
constexpr int most_revisions = 16;
constexpr std::size_t most_details = 64;

CampaignDirectory folder_of(const fs::path& campaign, const fs::path& directory) {
  return fs::is_directory(campaign) ? CampaignDirectory(campaign) : campaign_directory(campaign, directory);
}

std::shared_ptr<const std::string> shared(std::string text) {
  return std::make_shared<const std::string>(std::move(text));
}

}  // namespace

LiveCampaign::LiveCampaign(fs::path campaign, fs::path directory)
    : campaign_(std::move(campaign)),
      directory_(std::move(directory)),
      process_(
          fmt::format("{:x}-{:x}", getpid(), std::chrono::system_clock::now().time_since_epoch().count())) {
  read();
}

void LiveCampaign::refresh() {
  const Clock::time_point begun = Clock::now();
  if (begun < next_) return;
  const DatabaseStamp stamp = stamp_of(folder_of(campaign_, directory_));
  if (stamp == stamp_ && !doubtful_) return;
  stamp_ = stamp;
  doubtful_ = stamp.is_fresh(std::chrono::system_clock::now());
  try {
    read();
  } catch (const std::exception& error) {
    doubtful_ = true;
    tell(printable_lines(error.what()));
  }
  const Clock::time_point ended = Clock::now();
  next_ = ended + 9 * (ended - begun);
}

void LiveCampaign::read() {
  if (awaits_its_first_run(campaign_, directory_)) {
    wait_for_beginning();
    return;
  }
  try {
    OpenCampaign open = open_campaign(campaign_, directory_);
    become(reader_.read(open.database, current_owner(open.directory), false));
  } catch (const BeingSetUp& error) {
    doubtful_ = true;
    wait_for_beginning(error.allowed());
  }
}

// Throws InputError for a faulty campaign, which `run` would refuse.
void LiveCampaign::wait_for_beginning(const std::string& set_up) {
  const bool is_file = fs::is_regular_file(campaign_);
  const std::string name = is_file ? read_new_campaign(campaign_, directory_).name : campaign_.string();
  become({{"campaign", name},
          {"waiting", set_up.empty() ? fmt::format("Nothing has been run yet. Waiting for `peclet run {}`.",
                                                   words_for(campaign_, directory_))
                                     : set_up}});
}

void LiveCampaign::become(Json document) {
  name_ = document.at("campaign").get<std::string>();
  exit_code_ =
      document.contains("progress") ? document["progress"]["check"].get<int>() : int{ExitCode::unfinished};
  Json points = Json::array();
  if (const auto found = document.find("points"); found != document.end()) {
    points = std::move(*found);
    document.erase("points");
  }
  const int next = revision_ + 1;
  bool changed = points.size() != points_.size();
  points_.resize(points.size());
  const auto take = [&](Part& part, Json json) {
    std::string text = json.dump();
    if (text == part.text) return;
    part = {std::move(json), std::move(text), next};
    changed = true;
  };
  for (std::size_t place = 0; place < points_.size(); ++place) take(points_[place], std::move(points[place]));
  take(head_, std::move(document));
  if (changed) advance_to(next);
}

void LiveCampaign::tell(const std::string& fault) {
  if (head_.json.value("fault", "") == fault) return;
  head_.json["fault"] = fault;
  head_.text.clear();  // so that the next reading counts as a change
  advance_to(revision_ + 1);
}

void LiveCampaign::advance_to(int revision) {
  revision_ = revision;
  page_.reset();
  changes_.clear();
}

Json LiveCampaign::live() const {
  return {{"token", fmt::format("{}.{}", process_, revision_)}, {"program", page_program()}};
}

std::shared_ptr<const std::string> LiveCampaign::page() {
  if (!page_) {
    Json document = head_.json;
    document["points"] = Json::array();
    for (const Part& point : points_) document["points"].push_back(point.json);
    document["live"] = live();
    page_ = shared(page_html(document));
  }
  return page_;
}

std::shared_ptr<const std::string> LiveCampaign::changes_since(const std::string& token) {
  int since = 0;
  if (token.starts_with(process_ + '.')) {
    std::from_chars(token.data() + process_.size() + 1, token.data() + token.size(), since);
  }
  if (since == revision_) return nullptr;
  // A token that is invalid or too old gets everything, so that a bounded number of texts is kept.
  if (since < std::max(revision_ - most_revisions, 0) || since > revision_) since = 0;
  Text& known = changes_[since];
  if (!known) {
    std::string points;
    for (std::size_t place = 0; place < points_.size(); ++place) {
      if (points_[place].revision <= since) continue;
      points += fmt::format("{}\"{}\":{}", points.empty() ? "" : ",", place, points_[place].text);
    }
    known = shared(fmt::format(R"({{"live":{},"head":{},"count":{},"points":{{{}}}}})", live().dump(),
                               head_.json.dump(), points_.size(), points));
  }
  return known;
}

std::shared_ptr<const std::string> LiveCampaign::details(const std::string& hash) {
  const std::optional<std::string> key = reader_.key(hash);
  if (!key) return nullptr;
  if (details_.size() >= most_details && !details_.contains(hash)) details_.clear();
  Details& known = details_[hash];
  const Clock::time_point begun = Clock::now();
  if (known.text && (known.key == *key || begun < detailed_)) return known.text;
  OpenCampaign open = open_campaign(campaign_, directory_);
  known = {*key, shared(reader_.details(open.database, hash).dump())};
  const Clock::time_point ended = Clock::now();
  detailed_ = ended + 9 * (ended - begun);
  return known.text;
}

}  // namespace peclet::runner
