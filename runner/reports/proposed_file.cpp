#include "runner/reports/proposed_file.h"

#include <fmt/format.h>

#include "contract/durable_file.h"
#include "contract/errors.h"
#include "contract/named_files.h"
#include "runner/campaign/campaign.h"
#include "runner/campaign/quoting.h"
#include "runner/campaign/sweep.h"
#include "runner/owner/open_campaign.h"

namespace peclet::runner {

CampaignSource source_of(const fs::path& given, const CampaignRecord& campaign) {
  const fs::path file = campaign_file_of(given);
  if (fs::is_regular_file(file)) return {file, read_input(file)};
  return {given, campaign.document.dump(2) + '\n'};
}

Json sweep_of(const CampaignSource& source) {
  const std::string file = source.file.string();
  const Json document = campaign_keys().validate(parse_json_input(source.text, file), file);
  return without_ranges(document["sweep"], file);
}

void check_new_file(const fs::path& file) {
  if (file.empty()) return;
  if (fs::symlink_status(file).type() != fs::file_type::not_found) {
    throw InputError(file.string(), "", "--write",
                     "is there already, and is never replaced: name another file");
  }
  check_output(file);
}

std::string write_proposed(const fs::path& file, const std::string& text,
                           const CampaignDirectory& directory) {
  parse_campaign(parse_json_input(text, file.string()), file.string());
  write_durably(file, text);
  return fmt::format("wrote {0}; `peclet run {1} --directory {2}` adds its points to the campaign\n",
                     file.string(), shell_word(file.string()), shell_word(directory.root().string()));
}

}  // namespace peclet::runner
