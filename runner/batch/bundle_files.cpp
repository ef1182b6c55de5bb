#include "runner/batch/bundle_files.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <system_error>

#include "contract/durable_file.h"
#include "contract/errors.h"
#include "runner/store/blame.h"
#include "runner/store/result_files.h"
#include "runner/store/spool.h"

namespace peclet::runner {
namespace {

namespace fs = std::filesystem;

template <typename Number>
Json number_or_null(const std::optional<Number>& number) {
  return number ? Json(*number) : Json(nullptr);
}

std::optional<int> optional_number(const Json& value) {
  return value.is_null() ? std::nullopt : std::optional(value.get<int>());
}

std::optional<int> place_of(const Manifest& manifest, int task, const RealisationResult& result) {
  for (const int place : manifest.tasks.at(static_cast<std::size_t>(task))) {
    const BundledSeed& known = manifest.seeds.at(static_cast<std::size_t>(place));
    if (known.point == result.point && known.seed == result.seed) return place;
  }
  return std::nullopt;
}

}  // namespace

Json manifest_json(const Manifest& manifest) {
  Json seeds = Json::array();
  for (const BundledSeed& seed : manifest.seeds)
    seeds.push_back({{"point", seed.point}, {"seed", seed.seed}});
  return {{"schema_version", 1},
          {"bundle", manifest.name},
          {"campaign", manifest.campaign},
          {"engine", manifest.engine},
          {"engine_folder", manifest.engine_folder.string()},
          {"engine_identity", manifest.engine_identity},
          {"threads", manifest.threads},
          {"lease_seconds", manifest.lease_seconds},
          {"checkpoint_seconds", manifest.checkpoint_seconds},
          {"scenes", manifest.scenes},
          {"seeds", seeds},
          {"tasks", manifest.tasks}};
}

Manifest read_manifest(const fs::path& path) {
  const Json document = read_json(path);
  try {
    if (document.at("schema_version") != 1) {
      throw InputError(path.string(), "/schema_version", document.at("schema_version").dump(),
                       "this peclet reads version 1: the node needs the owner's version of peclet");
    }
    Manifest manifest;
    document.at("bundle").get_to(manifest.name);
    document.at("campaign").get_to(manifest.campaign);
    document.at("engine").get_to(manifest.engine);
    manifest.engine_folder = document.at("engine_folder").get<std::string>();
    document.at("engine_identity").get_to(manifest.engine_identity);
    document.at("threads").get_to(manifest.threads);
    document.at("lease_seconds").get_to(manifest.lease_seconds);
    document.at("checkpoint_seconds").get_to(manifest.checkpoint_seconds);
    manifest.scenes = document.at("scenes");
    document.at("tasks").get_to(manifest.tasks);
    for (const Json& seed : document.at("seeds")) {
      manifest.seeds.push_back({seed.at("point").get<std::string>(), seed.at("seed").get<int>()});
    }
    return manifest;
  } catch (const Json::exception& error) {
    throw InputError(path.string(), "", "", fmt::format("is no manifest of a bundle: {}", error.what()));
  }
}

BundleFolder BundleFolder::of_manifest(const fs::path& manifest) {
  const fs::path root = fs::absolute(manifest).lexically_normal().parent_path();
  return {root.parent_path().parent_path(), root.filename().string()};
}

void BundleFolder::create(int tasks) const {
  for (const fs::path& folder :
       {shared_.rejected(), shared_.left(), shared_.checkpoints(), shared_.failures(), logs()}) {
    fs::create_directories(folder);
  }
  fs::create_directories(root_ / "ended");
  for (int index = 0; index < tasks; ++index) fs::create_directories(task(index));
}

bool is_there(const BundleFolder& folder, std::string& why) {
  for (const fs::path& path : {folder.shared().root(), folder.root(), folder.manifest()}) {
    std::error_code error;
    if (fs::exists(path, error)) continue;
    why = fmt::format("{}: {}", path.string(), error ? error.message() : "is not there");
    return false;
  }
  return true;
}

std::string handed_over_advice(const std::vector<HandedOver>& bundles, const std::string& words) {
  int seeds = 0;
  std::string lost;
  for (const HandedOver& bundle : bundles) {
    seeds += bundle.seeds;
    std::string why;
    if (!is_there(BundleFolder(bundle.shared, bundle.bundle), why)) lost += " --forget " + bundle.bundle;
  }
  if (seeds == 0) return "";
  std::string text = fmt::format(
      "\n{} seeds are handed over: `peclet ingest {}` takes in what has been done, and with --cancel takes "
      "them back\n",
      seeds, words);
  if (!lost.empty()) {
    text += fmt::format("where their folder is gone for good, `peclet ingest {}{}` queues them again\n",
                        words, lost);
  }
  return text;
}

std::string result_name(const BundledSeed& seed) {
  return fmt::format("{}-{:06}-", seed.point.substr(0, 16), seed.seed);
}

void write_report(const fs::path& path, int place, const AttemptReport& report) {
  const Json document{{"schema_version", 1},
                      {"place", place},
                      {"outcome", to_string(report.outcome)},
                      {"step", report.step},
                      {"exit_status", number_or_null(report.ending.status)},
                      {"signal", number_or_null(report.ending.signal)},
                      {"message", report.message},
                      {"host", report.host},
                      {"process", report.process},
                      {"started_at", report.started_at},
                      {"engine", report.engine}};
  write_durably(path, document.dump(1) + '\n');
}

std::optional<PlacedReport> read_report(const fs::path& path) {
  if (!fs::exists(path)) return std::nullopt;
  const Json document = read_json(path);
  try {
    PlacedReport placed;
    document.at("place").get_to(placed.place);
    AttemptReport& report = placed.report;
    report.outcome = attempt_outcome(document.at("outcome").get<std::string>());
    document.at("step").get_to(report.step);
    report.ending = {optional_number(document.at("exit_status")), optional_number(document.at("signal"))};
    document.at("message").get_to(report.message);
    document.at("host").get_to(report.host);
    document.at("process").get_to(report.process);
    document.at("started_at").get_to(report.started_at);
    report.engine = document.at("engine");
    return placed;
  } catch (const Json::exception& error) {
    throw InputError(path.string(), "", "", fmt::format("is no report of an attempt: {}", error.what()));
  }
}

void publish_results(const BundleFolder& folder, const Manifest& manifest, int task) {
  for (const fs::directory_entry& entry : fs::directory_iterator(folder.task(task))) {
    const fs::path& file = entry.path();
    if (file.extension() != ".result") continue;
    try {
      const RealisationResult result = read_spool_file(file, "");
      const std::optional<int> place = place_of(manifest, task, result);
      if (!place || !file.filename().string().starts_with(
                        result_name(manifest.seeds[static_cast<std::size_t>(*place)]))) {
        throw ResultError("it is of another seed than the one that was asked for");
      }
      // First the note, then the move: a task that is run again finds one of the two and runs nothing twice.
      if (!fs::exists(folder.ended(*place))) {
        AttemptReport report;
        report.outcome = AttemptOutcome::result;
        report.engine = result.document.at("engine");
        write_report(folder.ended(*place), *place, report);
      }
      const fs::path spool = folder.shared().spool() / (file.stem().string() + ".json");
      create_folders_durably(left_folder(spool));  // somebody may have deleted it
      // What was moved before somebody died is in its place; what is in neither, the owner misses.
      for (const fs::path& left : left_files_of(file)) {
        rename_durably(left, left_folder(spool) / left.filename());
      }
      rename_durably(file, spool);
    } catch (const ResultError&) {
      reject(folder.shared(), file);
    }
  }
}

}  // namespace peclet::runner
