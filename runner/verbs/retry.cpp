#include "runner/verbs/retry.h"

#include "runner/campaign/campaign_file.h"
#include "runner/owner/open_campaign.h"

namespace peclet::runner {

Reply retry_seeds(const RetryOptions& options) {
  const CampaignDirectory directory = find_campaign(options.campaign, options.directory);
  const Request request = write_request(directory, Retry{options.points, options.seeds});
  return await_reply(directory, request, words_for(campaign_file_of(options.campaign), options.directory),
                     options.patience);
}

}  // namespace peclet::runner
