#include "runner/owner/request.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <limits>
#include <random>
#include <system_error>

#include "contract/durable_file.h"
#include "contract/guarded_file.h"

namespace peclet::runner {
namespace {

namespace fs = std::filesystem;

constexpr int request_version = 1;
// Of the names of a thousand points and their seeds there are some 100 kB.
constexpr std::uint64_t largest_request = 1 << 20;

// "20261122T031500.123456-4711-9f3a6c21": by time, and different even if two are made at once.
std::string new_name() {
  using namespace std::chrono;
  const auto now = system_clock::now();
  const auto microsecond = duration_cast<microseconds>(now.time_since_epoch()).count() % 1'000'000;
  return fmt::format("{:%Y%m%dT%H%M%S}.{:06}-{}-{:08x}", fmt::gmtime(system_clock::to_time_t(now)),
                     microsecond, getpid(), std::random_device{}());
}

Json as_json(const TakeOver& wish) {
  return {{"verb", "take-over"}, {"file", wish.file.string()}, {"sha256", wish.sha256}};
}
Json as_json(const Prioritise& wish) {
  return {{"verb", "prioritise"}, {"points", wish.points}, {"priority", wish.priority}};
}
Json as_json(const Cancel& wish) {
  return {{"verb", "cancel"}, {"points", wish.points}, {"undo", wish.undo}};
}
Json as_json(const Retry& wish) {
  return {{"verb", "retry"}, {"points", wish.points}, {"seeds", wish.seeds}};
}

// Judged before anything is done with it: requests are written by this program, but lie where others may
// write, too.
[[noreturn]] void refuse(const std::string& key, const std::string& allowed) {
  throw RequestError(fmt::format("/{}: must be {}", key, allowed));
}

const Json& member(const Json& json, const std::string& key) {
  const auto found = json.find(key);
  if (found == json.end()) refuse(key, "there");
  return *found;
}

std::string text(const Json& json, const std::string& key) {
  const Json& value = member(json, key);
  if (!value.is_string()) refuse(key, "a text");
  return value;
}

int whole_number(const Json& value, const std::string& key, int least) {
  const bool is_small = value.is_number_unsigned()
                            ? value.get<std::uint64_t>() <= std::numeric_limits<int>::max()
                            : value.is_number_integer() && value.get<std::int64_t>() >= least;
  if (!is_small) {
    refuse(key, fmt::format("a whole number from {} to {}", least, std::numeric_limits<int>::max()));
  }
  return value.get<int>();
}

const Json& list(const Json& json, const std::string& key) {
  const Json& value = member(json, key);
  if (!value.is_array()) refuse(key, "a list");
  return value;
}

std::vector<std::string> names(const Json& json, const std::string& key) {
  std::vector<std::string> names;
  for (const Json& value : list(json, key)) {
    if (!value.is_string()) refuse(key, "a list of texts");
    names.push_back(value);
  }
  return names;
}

std::vector<int> seeds(const Json& json, const std::string& key) {
  std::vector<int> seeds;
  for (const Json& value : list(json, key)) seeds.push_back(whole_number(value, key, 0));
  return seeds;
}

bool truth(const Json& json, const std::string& key) {
  const Json& value = member(json, key);
  if (!value.is_boolean()) refuse(key, "true or false");
  return value;
}

Wish wish_of(const Json& json) {
  if (!json.is_object()) refuse("", "an object");
  if (const Json& version = member(json, "version"); version != request_version) {
    throw RequestError(
        fmt::format("is of another version than {}, which this peclet knows", request_version));
  }
  const std::string verb = text(json, "verb");
  if (verb == "take-over") return TakeOver{text(json, "file"), text(json, "sha256")};
  if (verb == "prioritise") {
    const int priority = whole_number(member(json, "priority"), "priority", std::numeric_limits<int>::min());
    return Prioritise{names(json, "points"), priority};
  }
  if (verb == "cancel") return Cancel{names(json, "points"), truth(json, "undo")};
  if (verb == "retry") return Retry{names(json, "points"), seeds(json, "seeds")};
  throw RequestError("/verb: asks for what this peclet does not know");
}

}  // namespace

fs::path request_file(const CampaignDirectory& directory, const std::string& name) {
  return directory.requests() / (name + ".json");
}

Request write_request(const CampaignDirectory& directory, const Wish& wish) {
  Request request{new_name(), wish};
  Json json = std::visit([](const auto& asked) { return as_json(asked); }, wish);
  json["version"] = request_version;
  require_own_folder(directory.requests());
  fs::create_directories(directory.requests());
  write_durably(request_file(directory, request.name), json.dump(1) + '\n');
  return request;
}

Request read_request(const fs::path& file) {
  try {
    return {file.stem().string(), wish_of(parse_json(read_regular(file, largest_request), ""))};
  } catch (const UnsuitableFile& error) {
    throw RequestError(fmt::format("{}, and {}", error.value(), error.allowed()));
  } catch (const InputError& error) {
    throw RequestError(error.what());
  } catch (const std::system_error& error) {
    throw RequestError(error.code().message());
  }
}

std::vector<fs::path> waiting_requests(const CampaignDirectory& directory) {
  std::vector<fs::path> files;
  if (!fs::is_directory(directory.requests())) return files;
  for (const fs::directory_entry& entry : fs::directory_iterator(directory.requests())) {
    if (entry.path().extension() == ".json") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::optional<fs::path> set_request_aside(const fs::path& file) {
  const fs::path aside = free_name(file.string() + ".rejected");
  std::error_code error;  // somebody may have removed it
  fs::rename(file, aside, error);
  if (error && error != std::errc::no_such_file_or_directory) return std::nullopt;
  return aside;
}

}  // namespace peclet::runner
