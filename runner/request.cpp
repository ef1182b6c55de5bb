#include "runner/request.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <random>
#include <system_error>

#include "contract/durable_file.h"
#include "contract/input_error.h"

namespace peclet::runner {
namespace {

namespace fs = std::filesystem;

constexpr int request_version = 1;

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

Wish wish_of(const Json& json) {
  const auto points = [&] { return json.at("points").get<std::vector<std::string>>(); };
  const std::string verb = json.at("verb");
  if (verb == "take-over") {
    return TakeOver{json.at("file").get<std::string>(), json.at("sha256").get<std::string>()};
  }
  if (verb == "prioritise") return Prioritise{points(), json.at("priority").get<int>()};
  if (verb == "cancel") return Cancel{points(), json.at("undo").get<bool>()};
  if (verb == "retry") return Retry{points(), json.at("seeds").get<std::vector<int>>()};
  throw RequestError(fmt::format("asks to \"{}\", which this peclet does not know", verb));
}

}  // namespace

fs::path request_file(const CampaignDirectory& directory, const std::string& name) {
  return directory.requests() / (name + ".json");
}

Request write_request(const CampaignDirectory& directory, const Wish& wish) {
  Request request{new_name(), wish};
  Json json = std::visit([](const auto& asked) { return as_json(asked); }, wish);
  json["version"] = request_version;
  fs::create_directories(directory.requests());
  write_durably(request_file(directory, request.name), json.dump(1) + '\n');
  return request;
}

Request read_request(const fs::path& file) {
  try {
    const Json json = parse_json(read_file(file), file.string());
    if (const Json& version = json.at("version"); version != request_version) {
      throw RequestError(
          fmt::format("is of version {}; this peclet knows {}", version.dump(), request_version));
    }
    return {file.stem().string(), wish_of(json)};
  } catch (const InputError& error) {
    throw RequestError(error.what());
  } catch (const Json::exception& error) {
    throw RequestError(error.what());
  } catch (const std::system_error& error) {
    throw RequestError(error.what());
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

fs::path set_request_aside(const fs::path& file) {
  fs::path aside = file.string() + ".rejected";
  if (fs::exists(file)) fs::rename(file, aside);  // somebody may have removed it
  return aside;
}

}  // namespace peclet::runner
