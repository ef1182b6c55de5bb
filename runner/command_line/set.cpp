#include "runner/command_line/set.h"

#include <fmt/format.h>

#include <charconv>
#include <stdexcept>
#include <utility>

#include "contract/durable_file.h"
#include "contract/errors.h"
#include "contract/named_files.h"
#include "contract/sha256.h"
#include "runner/campaign/campaign_file.h"
#include "runner/engines/engine_process.h"
#include "runner/engines/scene_check.h"
#include "runner/owner/open_campaign.h"
#include "runner/store/locks.h"

namespace peclet::runner {
namespace {

namespace fs = std::filesystem;

struct Edit {
  std::string block;  // "": the document
  const char* key;
  Json value;
};

// What is no number is refused with the file.
Json word_or_number(const std::string& text) {
  int number = 0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), number);
  return read.ec == std::errc{} && read.ptr == text.data() + text.size() ? Json(number) : Json(text);
}

std::vector<Edit> edits_of(const SetOptions& options) {
  std::vector<Edit> edits;
  if (options.tolerance) edits.push_back({"target", "relative_tolerance", *options.tolerance});
  if (options.absolute_tolerance)
    edits.push_back({"target", "absolute_tolerance", *options.absolute_tolerance});
  if (options.confidence) edits.push_back({"target", "confidence", *options.confidence});
  if (options.minimum) edits.push_back({"realisations", "minimum", *options.minimum});
  if (options.maximum) edits.push_back({"realisations", "maximum", *options.maximum});
  if (options.realisations) edits.push_back({"", "realisations", *options.realisations});
  if (options.keep_files) edits.push_back({"", "keep_files", word_or_number(*options.keep_files)});
  return edits;
}

void check_usage(const SetOptions& options) {
  if (options.priority && options.points.empty()) {
    throw InputError("", "", "--priority", "needs the points that are to have it: --point, once for each");
  }
  if (!options.priority && !options.points.empty()) {
    throw InputError("", "", "--point", "is for --priority; target and realisations are those of all points");
  }
  if (options.priority && !edits_of(options).empty()) {
    throw InputError("", "", "--priority", "is no part of the campaign file: set it in a call of its own");
  }
}

// Refuses what the campaign does not have: a tolerance of the other kind, the number of seeds of a campaign
// with a target, and target and bounds where that number is fixed.
void check_kind(const Json& document, const SetOptions& options) {
  const Json realisations = document.is_object() ? document.value("realisations", Json()) : Json();
  if (realisations.is_null()) return;  // a missing one is refused with the file
  const bool is_fixed = realisations.is_number();
  const bool wants_target = options.tolerance || options.absolute_tolerance || options.confidence ||
                            options.minimum || options.maximum;
  if (is_fixed ? wants_target : options.realisations.has_value()) {
    throw InputError(options.campaign.string(), "/realisations", shortened(realisations),
                     is_fixed
                         ? "is a fixed number, changed by --realisations; a target in its place is written "
                           "into the file, which `peclet set` without options takes over"
                         : "belongs to a target, and is changed by --minimum and --maximum; a fixed number "
                           "in its place is written into the file, without the target, which `peclet set` "
                           "without options takes over");
  }
  const auto must_not_have = [&](const std::optional<double>& given, const char* option, const char* other,
                                 const char* other_option) {
    const Json::json_pointer there(other);
    if (!given || !document.contains(there)) return;
    throw InputError(options.campaign.string(), other, shortened(document[there]),
                     fmt::format("is changed by {}, not by {}", other_option, option));
  };
  must_not_have(options.tolerance, "--tolerance", "/target/absolute_tolerance", "--absolute-tolerance");
  must_not_have(options.absolute_tolerance, "--absolute-tolerance", "/target/relative_tolerance",
                "--tolerance");
}

// The text as it is to be.
std::string edited(const std::string& text, const std::vector<Edit>& edits, const fs::path& file) {
  Json expected = parse_json_input(text, file.string());
  std::string changed = text;
  for (const Edit& edit : edits) {
    const bool has_block =
        expected.is_object() &&
        (edit.block.empty() || (expected.contains(edit.block) && expected[edit.block].is_object()));
    if (!has_block) parse_campaign(expected, file.string());  // refuses it, and says why
    std::vector<std::string> path{edit.block, edit.key};
    if (edit.block.empty()) path.erase(path.begin());
    changed = with_value(changed, path, edit.value);
    (edit.block.empty() ? expected : expected[edit.block])[edit.key] = edit.value;
  }
  if (parse_json_input(changed, file.string()) != expected) {
    throw std::logic_error(file.string() + ": could not be changed in place; change it by hand");
  }
  return changed;
}

Reply take_over(const SetOptions& options) {
  const CampaignDirectory directory = campaign_directory(options.campaign, options.directory);
  if (!fs::is_regular_file(options.campaign)) {
    throw InputError(
        options.campaign.string(), "", "",
        fs::exists(options.campaign) ? "must be the campaign file: it is what counts" : "no such file");
  }
  const fs::path file = fs::canonical(options.campaign);
  Request request;
  std::string before, text;
  {
    const FileLock lock(file);  // two verbs at once: the second one reads what the first has written
    before = read_input(file);
    check_kind(parse_json_input(before, options.campaign.string()), options);
    text = edited(before, edits_of(options), options.campaign);
    const Campaign campaign =
        parse_campaign(parse_json_input(text, options.campaign.string()), options.campaign.string());
    check_scenes(campaign, options.campaign, resolve_engine(campaign, options.campaign));
    if (text != before) write_durably(file, text);
    if (!fs::exists(directory.database())) {
      return {fmt::format("{} is {}; it has not been run yet: peclet run {}\n", options.campaign.string(),
                          text != before ? "changed" : "sound, and as it was",
                          words_for(options.campaign, options.directory))};
    }
    request = write_request(directory, TakeOver{file, sha256(text)});
  }
  try {
    return await_reply(directory, request, words_for(options.campaign, options.directory), options.patience);
  } catch (const InputError&) {
    const FileLock lock(file);  // what is refused leaves the file as it was, unless somebody went on with it
    if (read_input(file) == text && text != before) write_durably(file, before);
    throw;
  }
}

}  // namespace

Reply set_campaign(const SetOptions& options) {
  check_usage(options);
  if (!options.priority) return take_over(options);
  const CampaignDirectory directory = find_campaign(options.campaign, options.directory);
  const Request request = write_request(directory, Prioritise{options.points, *options.priority});
  return await_reply(directory, request, words_for(campaign_file_of(options.campaign), options.directory),
                     options.patience);
}

}  // namespace peclet::runner
