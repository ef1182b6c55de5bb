#include "runner/batch/bundle_files.h"

#include <fmt/format.h>

#include <system_error>

#include "contract/documents.h"
#include "contract/durable_file.h"
#include "contract/errors.h"
#include "runner/store/result_files.h"

namespace peclet::runner {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE_WITH_DEFAULT(BundledSeed, point, seed, halvings)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE_WITH_DEFAULT(Manifest, bundle, campaign, engine, engine_folder,
                                                engine_identity, threads, device, lease_seconds,
                                                checkpoint_seconds, scenes, seeds, tasks)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(AttemptReport, step, message, host, process, started_at, engine)

namespace {

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

const KeyTable& manifest_keys() {
  static const KeyTable table("Seeds of a campaign that are handed over to a batch system",
                              fmt::format(R"(
/schema_version | integer = 1
/bundle | string | Name of the bundle.
/campaign | string
/engine | array | Program and arguments, as the nodes find them.
/engine/* | string
/engine_folder | string | Folder in which the engine runs.
/engine_identity | string | Identity that the engine there must have.
/threads | integer >= 1 and <= 2147483647
/device? | one of auto, cuda, none | PECLET_DEVICE of the engine there; none unsets it.
/lease_seconds, /checkpoint_seconds | number > 0
/scenes | object | Scenes by hash of the point.
/seeds | array | Seeds in the order in which tasks take them.
/seeds/* | object
/seeds/*/point | string
/seeds/*/seed | integer >= 0 and < {}
/seeds/*/halvings | integer >= 0 and <= 31; default 0 | How often the number of seeds in its engine is halved,
    because engines died with it.
/tasks | array | Places in seeds, for each task.
/tasks/* | array
/tasks/*/* | integer >= 0 and <= 2147483647
)",
                                          most_realisations));
  return table;
}

Json manifest_json(const Manifest& manifest) {
  Json document = manifest;
  document["schema_version"] = 1;
  if (manifest.device.empty()) document.erase("device");
  for (Json& seed : document["seeds"]) {
    if (seed["halvings"] == 0) seed.erase("halvings");
  }
  return document;
}

Manifest read_manifest(const fs::path& path) {
  Json document = read_json(path);
  if (document.is_object() && document.value("schema_version", Json(1)) != 1) {
    throw InputError(path.string(), "/schema_version", shortened(document["schema_version"]),
                     "this peclet reads version 1: the node needs the owner's version of peclet");
  }
  return manifest_keys().validate(std::move(document), path.string()).get<Manifest>();
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
  Json document = report;
  document["schema_version"] = 1;
  document["place"] = place;
  document["outcome"] = to_string(report.outcome);
  document["exit_status"] = number_or_null(report.ending.status);
  document["signal"] = number_or_null(report.ending.signal);
  if (report.company > 0) document["company"] = report.company;
  write_durably(path, document.dump(1) + '\n');
}

const KeyTable& report_keys() {
  static const KeyTable table("How an attempt at a seed went on a node", R"(
/schema_version | integer = 1
/place | integer >= 0 and <= 2147483647 | Place of the seed in the manifest.
/outcome | one of running, result, crashed, hung, garbled, refused, drained, killed, abandoned
/step | count | Last step that was reported.
/company | integer >= 0 and <= 2147483647; default 0 | Other seeds in its engine when that died, if any of them
    may have done it.
/exit_status | integer >= -2147483648 and <= 2147483647 or null | Exit status of the engine; null if it had
    none.
/signal | integer >= 0 and <= 2147483647 or null | Signal that ended the engine; null if none did.
/message, /host, /started_at | string
/process | count
/engine | anything | Provenance as in the result; null if the engine gave none.
)");
  return table;
}

std::optional<PlacedReport> read_report(const fs::path& path) {
  if (!fs::exists(path)) return std::nullopt;
  const Json document = report_keys().validate(read_json(path), path.string());
  PlacedReport placed{document["place"], document.get<AttemptReport>()};
  placed.report.outcome = attempt_outcome(document["outcome"].get<std::string>());
  placed.report.company = document["company"];
  placed.report.ending = {optional_number(document["exit_status"]), optional_number(document["signal"])};
  return placed;
}

std::vector<PlacedReport> read_running(const BundleFolder& folder, int task) {
  std::vector<PlacedReport> running;
  std::error_code absent;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder.task(task), absent)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with("running") || entry.path().extension() != ".json") continue;
    if (const std::optional<PlacedReport> report = read_report(entry.path())) running.push_back(*report);
  }
  return running;
}

void publish_result(const BundleFolder& folder, const Manifest& manifest, int task, const fs::path& file) {
  try {
    const RealisationResult result = read_spool_file(file, "");
    const std::optional<int> place = place_of(manifest, task, result);
    if (!place || !file.filename().string().starts_with(
                      result_name(manifest.seeds[static_cast<std::size_t>(*place)]))) {
      throw ResultError("it is of another seed than the one that was asked for");
    }
    // The note comes first, then the move: a task that runs again finds one of them and runs nothing twice.
    if (!fs::exists(folder.ended(*place))) {
      AttemptReport report;
      report.outcome = AttemptOutcome::result;
      report.engine = result.document.at("engine");
      write_report(folder.ended(*place), *place, report);
    }
    const fs::path spool = folder.shared().spool() / (file.stem().string() + ".json");
    create_folders_durably(left_folder(spool));  // it may have been deleted
    // Files moved before a crash are in their places; the owner rejects a result without its files.
    for (const fs::path& left : left_files_of(file)) {
      rename_durably(left, left_folder(spool) / left.filename());
    }
    rename_durably(file, spool);
  } catch (const ResultError&) {
    reject(folder.shared(), file);
  }
}

void publish_results(const BundleFolder& folder, const Manifest& manifest, int task) {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder.task(task))) {
    if (entry.path().extension() == ".result") files.push_back(entry.path());
  }
  for (const fs::path& file : files) publish_result(folder, manifest, task, file);
}

}  // namespace peclet::runner
