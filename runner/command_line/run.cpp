#include "runner/command_line/run.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <exception>
#include <memory>
#include <set>

#include "contract/errors.h"
#include "contract/text.h"
#include "runner/batch/bundle_files.h"
#include "runner/campaign/campaign_file.h"
#include "runner/campaign/number_text.h"
#include "runner/command_line/print.h"
#include "runner/engines/engine_process.h"
#include "runner/engines/worker_process.h"
#include "runner/launch/launching.h"
#include "runner/maintenance/backup.h"
#include "runner/owner/dispatcher.h"
#include "runner/owner/event_stream.h"
#include "runner/owner/owned_campaign.h"
#include "runner/owner/pause.h"
#include "runner/owner/progress.h"
#include "runner/owner/request_handler.h"
#include "runner/reports/status.h"
#include "runner/statistics/scheduler.h"
#include "runner/store/disk_room.h"
#include "runner/store/sqlite.h"

namespace peclet::runner {
namespace {

std::string failure(const std::string& command, const std::string& why) {
  return printable_lines(fmt::format("--notify: {}: {}", command, why));
}

}  // namespace

std::string notify(const std::string& command, const RunOutcome& outcome) {
  namespace fs = std::filesystem;
  try {
    const CommandAnswer answer =
        run_command({"env", "PECLET_CAMPAIGN=" + fs::absolute(outcome.campaign).string(),
                     "PECLET_DIRECTORY=" + fs::absolute(outcome.directory).string(),
                     fmt::format("PECLET_EXIT_CODE={}", outcome.code),
                     "PECLET_SUMMARY=" + printable(outcome.summary), "/bin/sh", "-c", command},
                    std::chrono::minutes(1));
    if (!answer.succeeded()) return failure(command, answer.complaint());
    std::fputs((answer.output + answer.errors).c_str(), stderr);
    return "";
  } catch (const std::exception& error) {
    return failure(command, error.what());
  }
}

namespace {

// The workers of a run, and how they are launched on other machines; nothing if they run on this one.
struct Team {
  WorkerCount size;
  std::optional<Launching> launching;
};

// Throws InputError for options of launched workers that are at fault.
Team asked_team(const RunOptions& options) {
  if (options.launch.empty() && options.hosts.empty()) return {worker_count(options), {}};
  const Launching launching = read_launching(options.launch, options.hosts, options.workers);
  return {{launching.workers, std::max(1, options.threads)}, launching};
}

// Leaves at most one worker for each seed that the campaign may run.
void limit(WorkerCount& size, const Campaign& campaign) {
  const auto seeds = static_cast<std::int64_t>(campaign.points.size()) * campaign.maximum_realisations;
  size.workers = static_cast<int>(std::min<std::int64_t>(seeds, size.workers));
}

// Returns the engines of the team, by the commands that start them.
LaunchedWorkers commands_of(const Team& team, const RunOptions& options, const EngineCommand& engine) {
  const auto [workers, threads] = team.size;
  if (!team.launching) return {std::vector(static_cast<std::size_t>(workers), engine), {}};
  // A lost link is noticed before a job counts as standing still.
  return launched_workers(engine, *team.launching, workers, threads, options.lease_seconds / 2);
}

// Warns if the threads of all workers exceed the usable cores more than fourfold.
void judge_worker_count(const WorkerCount& size, RunListener& listener) {
  constexpr int tolerable = 4;
  const int cores = usable_cores();
  if (size.workers * std::int64_t{size.threads} <= std::int64_t{tolerable} * cores) return;
  listener.warn(fmt::format(
      "{} workers of {} threads share {} cores: that is slower than --workers {}, and takes more memory",
      size.workers, size.threads, cores, std::max(1, cores / size.threads)));
}

// The database and state of a run, ready for dispatch. The constructor completes what an earlier owner left
// unfinished, carries out waiting requests and accepts the engine if asked to.
struct OpenedRun {
  OpenedRun(const ClaimedCampaign& claimed, const RunOptions& options, RunListener& listener)
      : database(open_for_owner(claimed, [&](const std::string& text) { listener.note(text); })),
        state(database, adopted_campaign(database), claimed.directory, listener, retries),
        requests(database, state, claimed.directory, listener) {
    requests.carry_out();
    if (!options.accept_engine.empty()) accept_engine(state, claimed.engine, listener);
  }

  Database database;
  CampaignState state;
  RequestHandler requests;
  SummedError before;  // that before the run
};

// Opens the run; waits while the disk is full or another program has locked the database. Returns null if a
// signal came first, or if waiting cannot make room.
std::unique_ptr<OpenedRun> open_when_it_is_possible(const ClaimedCampaign& claimed, const RunOptions& options,
                                                    RunListener& listener, StopSignals& signals) {
  const std::filesystem::path& root = claimed.directory.root();
  std::set<std::string> told;
  while (true) {
    try {
      auto opened = std::make_unique<OpenedRun>(claimed, options, listener);
      if (!told.empty()) listener.happened(ShortageEnded{});
      return opened;
    } catch (const std::exception& error) {
      const std::optional<Hindrance> hindrance = hindrance_in(error, root);
      if (!hindrance) throw;
      const bool lacks_room = !hindrance->folder.empty();
      if (const std::string why = lacks_room ? why_in_vain(root, root, 0) : ""; !why.empty()) {
        listener.warn(why);
        return nullptr;
      }
      if (told.insert(hindrance->kind()).second) {
        listener.happened(ShortageBegan{hindrance->text});
        listener.warn(fmt::format("{}; the campaign begins {}", hindrance->text, hindrance->end));
      }
    }
    if (signals.wait(std::chrono::seconds(3))) return nullptr;
  }
}

RunBegan beginning(const ClaimedCampaign& claimed, const WorkerCount& size) {
  return {claimed.campaign.name,
          claimed.directory.root(),
          getpid(),
          static_cast<int>(claimed.campaign.points.size()),
          size.workers,
          size.threads};
}

int dispatch(OpenedRun& opened, const RunOptions& options, const ClaimedCampaign& claimed, const Team& team,
             RunLog& log, StopSignals& signals) {
  using std::chrono::steady_clock;
  const CampaignDirectory& directory = claimed.directory;
  const WorkerCount& size = team.size;
  if (!team.launching) judge_worker_count(size, log);
  allow_open_files(size.workers);
  PeriodicBackup backup(directory, std::chrono::duration<double>(options.backup_seconds), log,
                        steady_clock::now());
  FolderWatch watch(directory, claimed.lock, opened.database, log);
  DispatchSettings settings;
  settings.threads = size.threads;
  settings.lease = std::chrono::duration<double>(options.lease_seconds);
  settings.checkpoint_seconds = options.checkpoint_seconds;
  if (options.time_limit) settings.time_limit = std::chrono::duration<double>(*options.time_limit);
  settings.chore = [&backup, &watch] {
    // The folder is checked before the backup, which must not begin in a folder that has been moved.
    const bool mended = watch.attend(steady_clock::now());
    backup.attend(steady_clock::now());
    return mended;
  };
  settings.requests = [&opened] { return opened.requests.carry_out(); };
  log.record(fmt::format("{} begins: process {}, {} workers of {} threads, engine {}",
                         directory.root().string(), getpid(), size.workers, size.threads,
                         claimed.command.program.string()));
  LaunchedWorkers workers = commands_of(team, options, claimed.command);
  settings.hosts = std::move(workers.hosts);
  ProcessPool pool(std::move(workers.commands), directory, signals);
  Dispatcher dispatcher(opened.database, opened.state, pool, log, settings, steady_clock::now);
  const bool finished = dispatcher.run() == Dispatcher::Ending::finished;
  backup.finish();
  return ending(read_status(opened.database), finished);
}

// Reports the failure of a run to the listener, and writes it into the campaign's log if the run had begun.
void tell_of_failure(RunLog& log, bool had_begun, const std::exception& error) {
  if (had_begun) log.record(fmt::format("ends with an error: {}", error.what()));
  log.happened(RunEnded{exit_code_of(error), error.what()});
}

std::string how_to_go_on(const RunOptions& options, const CampaignStatus& status) {
  if (!status.handed_over.empty())
    return handed_over_advice(status.handed_over, words_for(options.campaign, options.directory));
  return fmt::format("\nstopped; all that was done is kept, and `peclet run {}` goes on from there\n",
                     words_for(options.campaign, options.directory));
}

Bounds bounds_of(const RunOptions& options, const ClaimedCampaign& claimed, std::optional<int> ceiling) {
  Bounds bounds{ceiling, {}, {}};
  const std::vector<double> work = particle_steps(claimed.scenes);
  for (std::size_t i = 0; i < work.size(); ++i) bounds.work[claimed.campaign.points[i].hash] = work[i];
  if (options.budget_hours) bounds.budget_seconds = seconds_per_hour * *options.budget_hours;
  return bounds;
}

// Prints the result of a run with this exit code.
using Conclusion = std::function<void(const ClaimedCampaign&, OpenedRun&, int code)>;

int run(const RunOptions& options, std::optional<int> ceiling, const Conclusion& conclude) {
  Team team = asked_team(options);  // before anything is written
  const ClaimedCampaign claimed(options.campaign, options.directory, options.force, options.accept_engine);
  limit(team.size, claimed.campaign);
  StopSignals signals;
  std::unique_ptr<OpenedRun> opened;
  int code = ExitCode::stopped;
  {
    Progress progress(Progress::style_of_stderr(options.quiet));
    std::optional<EventStream> events;
    if (options.jsonl) events.emplace(STDOUT_FILENO, progress);
    RunLog log(claimed.directory.run_log(), events ? static_cast<RunListener&>(*events) : progress);
    log.happened(beginning(claimed, team.size));
    if (const std::string doubt = doubt_about_file_system(claimed.directory.root()); !doubt.empty())
      log.warn(doubt);
    try {
      opened = open_when_it_is_possible(claimed, options, log, signals);
      if (opened) {
        opened->state.set_bounds(bounds_of(options, claimed, ceiling));
        opened->before = summed_error(opened->state.scheduler());
        code = dispatch(*opened, options, claimed, team, log, signals);
      }
    } catch (const OtherEngine& error) {
      const OtherEngine advised(
          error.what() +
          acceptance_hint("run " + words_for(options.campaign, options.directory), claimed.engine));
      tell_of_failure(log, opened != nullptr, advised);
      throw advised;
    } catch (const std::exception& error) {
      tell_of_failure(log, opened != nullptr, error);
      throw;
    }
    log.record(fmt::format("ends with exit code {}", code));
    log.happened(RunEnded{code, ""});
  }
  if (opened) conclude(claimed, *opened, code);
  return code;
}

// Returns the number of engines that fill the cards of this machine, one for each; 0 without a card, or if
// the device is another.
int workers_for_cards(const std::string& device) {
  if (device != "cuda" && device != "auto") return 0;
  const int cards = visible_cards();
  return device == "cuda" ? std::max(1, cards) : cards;
}

}  // namespace

WorkerCount worker_count(const RunOptions& options) {
  const int cores = usable_cores();
  const int workers = options.workers == 0 ? workers_for_cards(options.device) : options.workers;
  if (workers > 0 && options.threads > 0) return {workers, options.threads};
  if (workers > 0) return {workers, std::max(1, cores / workers)};
  const int threads = std::max(1, options.threads);
  return {std::max(1, cores / threads), threads};
}

namespace {

// Runs the campaign and prints the table at its end. `summary` gets the totals on one line.
int run_and_conclude(const RunOptions& options, std::string& summary) {
  return run(options, std::nullopt, [&](const ClaimedCampaign&, OpenedRun& opened, int code) {
    const CampaignStatus status = read_status(opened.database, getpid());
    summary = fmt::format("{}: {}{}", status.campaign.name, code == ExitCode::stopped ? "stopped; " : "",
                          point_totals(status));
    if (options.jsonl) return;
    std::string text = status_table(status);
    if (options.budget_hours) {
      text += budget_text(opened.state.spent_seconds(), seconds_per_hour * *options.budget_hours,
                          opened.before, summed_error(opened.state.scheduler()));
    }
    if (code == ExitCode::stopped) text += how_to_go_on(options, status);
    std::fputs(text.c_str(), stdout);
  });
}

// Calls the command of --notify, except for a faulty file and another owner, which the user sees at once.
void notify_of(const RunOptions& options, int code, const std::string& summary) {
  if (options.notify.empty() || code == ExitCode::usage || code == ExitCode::owned) return;
  const CampaignDirectory directory = campaign_directory(options.campaign, options.directory);
  const std::string failure = notify(options.notify, {options.campaign, directory.root(), code, summary});
  if (!failure.empty()) say(fmt::format("peclet: {}\n", failure));
}

}  // namespace

int run_campaign(const RunOptions& options) {
  choose_device(options.device);
  std::string summary;
  try {
    const int code = run_and_conclude(options, summary);
    notify_of(options, code, summary);
    return code;
  } catch (const std::exception& error) {
    notify_of(options, exit_code_of(error), message_of(error));
    throw;
  }
}

int run_pilot(const RunOptions& options, int seeds,
              const std::function<void(const ClaimedCampaign&, Database&)>& conclude) {
  const int code =
      run(options, seeds, [&](const ClaimedCampaign& claimed, OpenedRun& opened, int ended_with) {
        if (ended_with != ExitCode::stopped) conclude(claimed, opened.database);
      });
  // Points that are not decided are expected after a pilot.
  return code == ExitCode::integrity || code == ExitCode::stopped ? code : 0;
}

}  // namespace peclet::runner
