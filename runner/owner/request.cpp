#include "runner/owner/request.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <random>
#include <system_error>
#include <utility>

#include "contract/durable_file.h"
#include "contract/guarded_file.h"
#include "contract/sha256.h"

namespace peclet::runner {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(TakeOver, file, sha256)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Prioritise, points, priority)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Cancel, points, undo)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Retry, points, seeds)

namespace {

constexpr int request_version = 1;
// The names of a thousand points and their seeds take some 100 kB.
constexpr std::uint64_t largest_request = 1 << 20;

// Returns a name that sorts by time and is unique, even if two are made at once:
// "20261122T031500.123456-4711-9f3a6c21".
std::string new_name() {
  using namespace std::chrono;
  const auto now = system_clock::now();
  const auto microsecond = duration_cast<microseconds>(now.time_since_epoch()).count() % 1'000'000;
  return fmt::format("{:%Y%m%dT%H%M%S}.{:06}-{}-{:08x}", fmt::gmtime(system_clock::to_time_t(now)),
                     microsecond, getpid(), std::random_device{}());
}

constexpr const char* verbs[] = {"take-over", "prioritise", "cancel", "retry"};  // in the order of Wish

// Requires a document that request_keys() has checked.
Wish wish_of(const Json& json) {
  const std::string& verb = json["verb"].get_ref<const std::string&>();
  if (verb == verbs[0]) return json.get<TakeOver>();
  if (verb == verbs[1]) return json.get<Prioritise>();
  if (verb == verbs[2]) return json.get<Cancel>();
  return json.get<Retry>();
}

}  // namespace

const KindTables& request_keys() {
  static const KindTables tables("What a verb asks of the owner of a campaign: a file in requests/", "verb",
                                 R"(
/version | integer = 1

-- take-over | The campaign is taken over from its file.
/file | string
/sha256 | string | Hash of the campaign, with the content of its scene's file, whose scenes the
    engine has checked.

-- prioritise | Points come earlier or later.
/points | array | Labels, or digits of the hash.
/points/* | string
/priority | integer >= -2147483648 and <= 2147483647

-- cancel | Points get no more seeds; with undo they get seeds again.
/points | array | Labels, or digits of the hash.
/points/* | string
/undo | true or false

-- retry | Seeds that were given up are queued again; all of them if none is named.
/points | array | Labels, or digits of the hash.
/points/* | string
/seeds | array
/seeds/* | integer >= 0 and <= 2147483647
)");
  return tables;
}

fs::path request_file(const CampaignDirectory& directory, const std::string& name) {
  return directory.requests() / (name + ".json");
}

std::string hash_of(const Campaign& campaign) { return sha256(canonical_json(campaign.document)); }

Request write_request(const CampaignDirectory& directory, const Wish& wish) {
  Request request{new_name(), wish};
  Json json = std::visit([](const auto& asked) { return Json(asked); }, wish);
  json["verb"] = verbs[wish.index()];
  json["version"] = request_version;
  require_own_folder(directory.requests());
  fs::create_directories(directory.requests());
  write_durably(request_file(directory, request.name), json.dump(1) + '\n');
  return request;
}

Request read_request(const fs::path& file) {
  try {
    Json json = parse_json(read_regular(file, largest_request), "");
    if (json.is_object() && json.value("version", Json(request_version)) != request_version) {
      throw RequestError(
          fmt::format("has another version than {}, which this peclet reads", request_version));
    }
    return {file.stem().string(), wish_of(request_keys().validate(std::move(json), ""))};
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
  std::error_code error;  // the file may have been removed meanwhile
  fs::rename(file, aside, error);
  if (error && error != std::errc::no_such_file_or_directory) return std::nullopt;
  return aside;
}

}  // namespace peclet::runner
