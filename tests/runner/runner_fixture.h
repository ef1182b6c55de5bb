// A campaign in a temporary folder, and results made by hand.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "contract/json.h"
#include "runner/campaign/campaign.h"
#include "runner/owner/run_listener.h"
#include "runner/store/campaign_directory.h"

namespace peclet::runner {

// TemporaryFolder is removed at its end, with everything in it.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

// Returns a campaign without a file, with this number of points: scenes {"point": 0}, {"point": 1} ...
Campaign plain_campaign(int points, int minimum, int maximum, double tolerance);

// Returns a well-formed result of schema/result.schema.json; `identity` names the engine's binary.
Json plain_result(const std::string& point, int seed, double viscosity,
                  const std::string& identity = "engine");

// Returns the description of a ratio of "counts" and "ideal" along an axis with these values.
Json described_ratio(const Json& values);

bool says(const std::string& text, const std::string& part);

// Returns letters that compress badly, others for each `start` and the same on every platform.
std::string noise(std::size_t size, std::uint32_t start = 1);

// Returns the engine that plain_result() names.
Json plain_engine(const std::string& identity = "engine");

// SilentListener keeps what it is told.
class SilentListener : public RunListener {
 public:
  void note(const std::string& message) override { notes.push_back(message); }
  void warn(const std::string& message) override { warnings.push_back(message); }
  void happened(const RunEvent& event) override { events.push_back(event); }
  void report(const RunReport& report) override { last = report; }
  template <typename Event>
  std::ptrdiff_t count() const {
    return std::count_if(events.begin(), events.end(),
                         [](const RunEvent& event) { return std::holds_alternative<Event>(event); });
  }
  std::vector<std::string> notes, warnings;
  std::vector<RunEvent> events;
  RunReport last;
};

}  // namespace peclet::runner
