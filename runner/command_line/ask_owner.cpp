#include "runner/command_line/ask_owner.h"

#include <fmt/format.h>

#include <chrono>
#include <optional>
#include <thread>

#include "contract/errors.h"
#include "runner/campaign/campaign_file.h"
#include "runner/maintenance/restore.h"
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

constexpr std::chrono::milliseconds between_looks{100};

// Nobody runs the campaign: what waits is carried out here. False: somebody was faster.
bool carry_out_here(const CampaignDirectory& directory) {
  try {
    const OwnerLock lock(directory);
    refuse_lost_database(directory);
    create_folders(directory);
    Database database = Database::open_owner(directory.database());
    const Campaign campaign = parse_campaign(database.campaign().document, directory.database().string());
    Progress progress(Progress::style_of_stderr(true));
    Ledger ledger(database, campaign, directory, progress, retries);
    RequestHandler(database, ledger, directory, progress).carry_out();
    return true;
  } catch (const OwnedByAnother&) {
    return false;
  }
}

// Waits until the request's file is gone. False: it still is there.
bool is_carried_out(const CampaignDirectory& directory, const Request& request, double patience) {
  const fs::path file = request_file(directory, request.name);
  const auto end = Clock::now() + std::chrono::duration<double>(patience);
  for (;;) {
    try {
      if (!current_owner(directory)) carry_out_here(directory);
    } catch (...) {
      fs::remove(file);  // who is told that it failed must not find it done later
      throw;
    }
    if (!fs::exists(file)) return true;
    if (Clock::now() >= end) return false;
    std::this_thread::sleep_for(between_looks);
  }
}

std::string next_step(const CampaignDirectory& directory, Database& database, const std::string& words) {
  if (const std::optional<std::int64_t> owner = current_owner(directory)) {
    return fmt::format("process {} goes on with it; `peclet status {}` shows how far it is\n", *owner, words);
  }
  const CampaignStatus status = read_status(database);
  if (standing(status) != ExitCode::unfinished) return "no point is open: there is nothing to run\n";
  return fmt::format("go on with: peclet run {}\n", words);
}

Reply answer(const CampaignDirectory& directory, const Request& request, const std::string& words) {
  Database database = Database::open_reader(directory.database());
  const std::optional<EventRecord> event = database.event_of(request.name);
  if (!event) {
    throw IntegrityError(fmt::format(
        "{}: the campaign's owner could not read it; is that an older peclet? It is kept beside as "
        "*.rejected",
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
  if (patience <= 0) return {fmt::format("{} will come to it\n", owner)};
  return {fmt::format("{} has not come to it in {:g} s, but will: see `peclet status {}`\n", owner, patience,
                      words),
          ExitCode::unfinished};
}

Reply cancel_points(const CancelOptions& options) {
  const CampaignDirectory directory = find_campaign(options.campaign, options.directory);
  const Request request = write_request(directory, Cancel{options.points, options.undo});
  return await_reply(directory, request, words_for(campaign_file_of(options.campaign), options.directory),
                     options.patience);
}

Reply retry_seeds(const RetryOptions& options) {
  const CampaignDirectory directory = find_campaign(options.campaign, options.directory);
  const Request request = write_request(directory, Retry{options.points, options.seeds});
  return await_reply(directory, request, words_for(campaign_file_of(options.campaign), options.directory),
                     options.patience);
}

}  // namespace peclet::runner
