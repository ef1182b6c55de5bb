#include "runner/command_line/ask_owner.h"

#include <fmt/format.h>

#include <charconv>
#include <chrono>
#include <stdexcept>
#include <thread>

#include "contract/durable_file.h"
#include "contract/errors.h"
#include "contract/named_files.h"
#include "runner/campaign/campaign_file.h"
#include "runner/engines/engine_process.h"
#include "runner/engines/scene_check.h"
#include "runner/maintenance/backup.h"
#include "runner/owner/open_campaign.h"
#include "runner/owner/owned_campaign.h"
#include "runner/owner/progress.h"
#include "runner/owner/request_handler.h"
#include "runner/reports/status.h"
#include "runner/store/backups.h"
#include "runner/store/locks.h"

namespace peclet::runner {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds polling_interval{100};

// Owns the campaign while it carries out all waiting requests. Returns false if another process owns it.
bool carry_out_here(const CampaignDirectory& directory) {
  try {
    const OwnerLock lock(directory);
    refuse_lost_database(directory);
    create_folders(directory);
    Database database = Database::open_owner(directory.database());
    Progress progress(Progress::style_of_stderr(true));
    CampaignState state(database, adopted_campaign(database), directory, progress, retries);
    RequestHandler(database, state, directory, progress).carry_out();
    return true;
  } catch (const OwnedByAnother&) {
    return false;
  }
}

// Waits until the request's file is gone; carries the request out if the campaign has no owner.
bool is_carried_out(const CampaignDirectory& directory, const Request& request, double patience) {
  const fs::path file = request_file(directory, request.name);
  const auto end = Clock::now() + std::chrono::duration<double>(patience);
  for (;;) {
    try {
      if (!current_owner(directory)) carry_out_here(directory);
    } catch (...) {
      fs::remove(file);  // a request that was reported as failed must not be carried out later
      throw;
    }
    if (!fs::exists(file)) return true;
    if (Clock::now() >= end) return false;
    std::this_thread::sleep_for(polling_interval);
  }
}

std::string next_step(const CampaignDirectory& directory, Database& database, const std::string& words) {
  if (const std::optional<std::int64_t> owner = current_owner(directory)) {
    return fmt::format("process {} continues the campaign; `peclet status {}` shows its progress\n", *owner,
                       words);
  }
  const CampaignStatus status = read_status(database);
  if (exit_code_of(status) != ExitCode::unfinished) return "no point is open: there is nothing to run\n";
  return fmt::format("go on with: peclet run {}\n", words);
}

Reply answer(const CampaignDirectory& directory, const Request& request, const std::string& words) {
  Database database = Database::open_reader(directory.database());
  const std::optional<EventRecord> event = database.event_of(request.name);
  if (!event) {
    throw IntegrityError(
        fmt::format("{}: the campaign's owner could not read this request; is the owner an older peclet? The "
                    "request is kept in the same folder as *.rejected",
                    request_file(directory, request.name).string()));
  }
  if (event->kind == "refused") throw InputError("", "", "", event->message);
  return {fmt::format("{}: {}\n{}", event->kind, event->message, next_step(directory, database, words))};
}

}  // namespace

Reply await_reply(const CampaignDirectory& directory, const Request& request, const std::string& words,
                  double patience) {
  if (is_carried_out(directory, request, patience)) return answer(directory, request, words);
  const std::string owner = fmt::format("process {}", current_owner(directory).value_or(0));
  if (patience <= 0) return {fmt::format("{} will carry the request out\n", owner)};
  return {fmt::format("{} has not carried the request out within {:g} s, but will; see `peclet status {}`\n",
                      owner, patience, words),
          ExitCode::unfinished};
}

namespace {

// Writes a request for the campaign that the verb's options name, and awaits the reply.
template <typename Options>
Reply ask(const Options& options, const Wish& wish) {
  const CampaignDirectory directory = find_campaign(options.campaign, options.directory);
  return await_reply(directory, write_request(directory, wish),
                     words_for(campaign_file_of(options.campaign), options.directory), options.patience);
}

}  // namespace

Reply cancel_points(const CancelOptions& options) {
  return ask(options, Cancel{options.points, options.undo});
}

Reply retry_seeds(const RetryOptions& options) { return ask(options, Retry{options.points, options.seeds}); }

// `peclet set`: values are changed in the text of the file, which the campaign then takes over.

namespace {

struct Edit {
  std::vector<std::string> block;  // keys of nested objects; none: the document
  const char* key;
  Json value;
};

// Returns the number if the text is an integer, otherwise the text. Reading the file refuses a wrong word.
Json word_or_number(const std::string& text) {
  int number = 0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), number);
  return read.ec == std::errc{} && read.ptr == text.data() + text.size() ? Json(number) : Json(text);
}

// The pointer to the curve of a target.
constexpr const char* curve_pointer = "/target/curve";

std::vector<Edit> edits_of(const SetOptions& options, const Json& document) {
  std::vector<Edit> edits;
  std::vector<std::string> target{"target"}, of_tolerance = target;
  if (document.contains(Json::json_pointer(curve_pointer))) of_tolerance.emplace_back("curve");
  if (options.tolerance) edits.push_back({of_tolerance, "relative_tolerance", *options.tolerance});
  if (options.absolute_tolerance)
    edits.push_back({target, "absolute_tolerance", *options.absolute_tolerance});
  if (options.confidence) edits.push_back({target, "confidence", *options.confidence});
  if (options.minimum) edits.push_back({{"realisations"}, "minimum", *options.minimum});
  if (options.maximum) edits.push_back({{"realisations"}, "maximum", *options.maximum});
  if (options.realisations) edits.push_back({{}, "realisations", *options.realisations});
  if (options.keep_files) edits.push_back({{}, "keep_files", word_or_number(*options.keep_files)});
  return edits;
}

void check_usage(const SetOptions& options) {
  if (options.priority && options.points.empty()) {
    throw InputError("", "", "--priority", "needs the points that get it: one --point for each");
  }
  if (!options.priority && !options.points.empty()) {
    throw InputError("", "", "--point", "is for --priority; target and realisations apply to all points");
  }
  if (options.priority && !edits_of(options, {}).empty()) {
    throw InputError("", "", "--priority", "is not part of the campaign file: set it in a separate call");
  }
}

// Throws InputError for an option that does not suit the campaign: a tolerance of the other kind, a fixed
// number of seeds beside a target, or a target and bounds where that number is fixed.
void check_kind(const Json& document, const SetOptions& options) {
  const Json realisations = document.is_object() ? document.value("realisations", Json()) : Json();
  if (realisations.is_null()) return;  // reading the file refuses a missing one
  const bool is_fixed = realisations.is_number();
  const bool wants_target = options.tolerance || options.absolute_tolerance || options.confidence ||
                            options.minimum || options.maximum;
  if (is_fixed ? wants_target : options.realisations.has_value()) {
    throw InputError(
        options.campaign.string(), "/realisations", shortened(realisations),
        is_fixed
            ? "is a fixed number, changed by --realisations; to replace it by a target, edit the file and "
              "run `peclet set` without options"
            : "belongs to a target, and is changed by --minimum and --maximum; to replace it by a fixed "
              "number, remove the target from the file and run `peclet set` without options");
  }
  const auto must_not_have = [&](const std::optional<double>& given, const char* option, const char* other,
                                 const char* other_option) {
    const Json::json_pointer there(other);
    if (!given || !document.contains(there)) return;
    throw InputError(options.campaign.string(), other, shortened(document[there]),
                     fmt::format("is changed by {}, not by {}", other_option, option));
  };
  must_not_have(options.tolerance, "--tolerance", "/target/absolute_tolerance", "--absolute-tolerance");
  for (const char* const other : {"/target/relative_tolerance", curve_pointer})
    must_not_have(options.absolute_tolerance, "--absolute-tolerance", other, "--tolerance");
}

// Returns the text with the edits in place; every other byte stays.
std::string edited(const std::string& text, const std::vector<Edit>& edits, const fs::path& file) {
  Json expected = parse_json_input(text, file.string());
  std::string changed = text;
  for (const Edit& edit : edits) {
    Json::json_pointer block;
    for (const std::string& key : edit.block) block /= key;
    const bool has_block = expected.contains(block) && expected[block].is_object();
    if (!has_block) parse_campaign(expected, file.string());  // refuses it, and says why
    std::vector<std::string> path = edit.block;
    path.emplace_back(edit.key);
    changed = with_value(changed, path, edit.value);
    expected[block][edit.key] = edit.value;
  }
  if (parse_json_input(changed, file.string()) != expected) {
    throw std::logic_error(file.string() + ": could not be changed in place; change it by hand");
  }
  return changed;
}

Reply take_over(const SetOptions& options) {
  const CampaignDirectory directory = campaign_directory(options.campaign, options.directory);
  if (!fs::is_regular_file(options.campaign)) {
    throw InputError(options.campaign.string(), "", "",
                     fs::exists(options.campaign) ? "must be the campaign file, which `peclet set` changes"
                                                  : "no such file");
  }
  const fs::path file = fs::canonical(options.campaign);
  Request request;
  std::string before, text;
  {
    const FileLock lock(file);  // of two verbs at once, the second one reads what the first has written
    before = read_input(file);
    const Json document = parse_json_input(before, options.campaign.string());
    check_kind(document, options);
    text = edited(before, edits_of(options, document), options.campaign);
    const Campaign campaign =
        parse_campaign(parse_json_input(text, options.campaign.string()), options.campaign.string());
    check_scenes(campaign, options.campaign, resolve_engine(campaign, options.campaign));
    if (text != before) write_durably(file, text);
    if (!fs::exists(directory.database())) {
      return {fmt::format("{} is {}; it has not been run yet: peclet run {}\n", options.campaign.string(),
                          text != before ? "changed" : "valid and unchanged",
                          words_for(options.campaign, options.directory))};
    }
    request = write_request(directory, TakeOver{fs::absolute(options.campaign), hash_of(campaign)});
  }
  try {
    return await_reply(directory, request, words_for(options.campaign, options.directory), options.patience);
  } catch (const InputError&) {
    const FileLock lock(file);  // a refused change is undone, unless the file has changed since
    if (read_input(file) == text && text != before) write_durably(file, before);
    throw;
  }
}

}  // namespace

Reply set_campaign(const SetOptions& options) {
  check_usage(options);
  return options.priority ? ask(options, Prioritise{options.points, *options.priority}) : take_over(options);
}

}  // namespace peclet::runner
