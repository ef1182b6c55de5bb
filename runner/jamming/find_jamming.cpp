#include "runner/jamming/find_jamming.h"

#include <fmt/format.h>

#include <stdexcept>
#include <utility>

#include "contract/durable_file.h"
#include "contract/input_error.h"
#include "contract/input_file.h"
#include "contract/output_file.h"
#include "runner/campaign/campaign.h"
#include "runner/campaign/campaign_file.h"
#include "runner/campaign/document_edit.h"
#include "runner/owner/open_campaign.h"
#include "runner/text/quoting.h"

namespace peclet::runner {
namespace {

namespace fs = std::filesystem;

void check_usage(const JammingOptions& options) {
  if (options.estimate.common_exponent && options.estimate.form.exponent)
    throw InputError("", "", "--common-exponent", "does not go together with --exponent");
  if (options.estimate.common_exponent && options.by == "steepest")
    throw InputError("", "", "--common-exponent", "is of the law, which --by steepest leaves out");
  if (options.propose) return;
  if (options.budget) throw InputError("", "", "--budget", "is for --propose");
  if (!options.write.empty()) throw InputError("", "", "--write", "is for --propose");
}

// Before anything is read: what would be replaced is somebody's campaign.
void check_new_file(const fs::path& file) {
  if (file.empty()) return;
  if (fs::symlink_status(file).type() != fs::file_type::not_found) {
    throw InputError(file.string(), "", "--write",
                     "is there already, and is never replaced: name another file");
  }
  check_output(file);
}

// The campaign file as its author wrote it; without one, as it was last run.
struct Source {
  fs::path file;
  std::string text;
};

Source source_of(const JammingOptions& options, const CampaignRecord& campaign) {
  const fs::path file = campaign_file_of(options.campaign);
  if (fs::is_regular_file(file)) return {file, read_input(file)};
  return {options.campaign, campaign.document.dump(2) + '\n'};
}

// The file with the points is checked as any campaign is.
std::string with_points(const Source& source, const Json& sweep, const fs::path& written) {
  const std::string text = with_value(source.text, {"sweep"}, sweep);
  parse_campaign(parse_json_input(text, written.string()), written.string());
  return text;
}

std::string written_message(const JammingOptions& options, const CampaignDirectory& directory) {
  return fmt::format("wrote {0}; `peclet run {1} --directory {2}` adds its points to what there is\n",
                     options.write.string(), shell_word(options.write.string()),
                     shell_word(directory.root().string()));
}

std::string propose(JammingReport& report, const JammingOptions& options, const CampaignDirectory& directory,
                    const CampaignRecord& campaign) {
  report.proposed = propose_points(report.estimates, report.choice.form, options.budget);
  ProposedPoints& proposed = *report.proposed;
  if (proposed.points.empty()) return "";
  const Source source = source_of(options, campaign);
  const Json document = parse_json_input(source.text, source.file.string());
  const SweepChange change = add_to_sweep(document.value("sweep", Json::array()), report.campaign.over,
                                          proposed.points, source.file.string());
  proposed.patch = change.patch;
  if (options.write.empty()) return "";
  const std::string text = with_points(source, change.sweep, options.write);
  write_durably(options.write, text);
  return written_message(options, directory);
}

}  // namespace

JammingAnswer find_jamming(const JammingOptions& options) {
  check_usage(options);
  check_new_file(options.write);
  OpenCampaign open = open_campaign(options.campaign, options.directory);
  const CampaignRecord campaign = open.database.campaign();
  JammingReport report{.campaign = read_curves(open.database, options.curves),
                       .choice = options.estimate,
                       .softest = options.curves.softest,
                       .by_law = options.by != "steepest",
                       .by_steepest = options.by != "law",
                       .common = {},
                       .estimates = {},
                       .proposed = {}};
  JammingEstimates estimates = estimate_all(report.campaign.curves, options.estimate);
  report.common = std::move(estimates.common);
  report.estimates = std::move(estimates.curves);
  JammingAnswer answer;
  if (const std::string note = difference_from_file(options.campaign, options.directory, campaign);
      !note.empty()) {
    answer.message = fmt::format("note: {}\n", note);
  }
  if (options.propose) answer.message += propose(report, options, open.directory, campaign);
  answer.text = options.json ? jamming_json(report).dump(2) + '\n' : jamming_table(report);
  return answer;
}

}  // namespace peclet::runner
