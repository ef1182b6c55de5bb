#include "runner/options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "contract/nearest_name.h"
#include "contract/provenance.h"
#include "runner/parser_tree.h"
#include "runner/verb_pages.h"

namespace peclet::runner {
namespace {

constexpr int exit_usage = 2;

std::string version_text() {
  const Json& origin = provenance();
  return fmt::format("peclet {} (commit {}{})", version(), origin.value("git_commit", "unknown"),
                     origin.value("git_dirty", Json()) == true ? ", with changes" : "");
}

std::string exit_code_lines() {
  std::string text = "Exit codes:\n";
  for (const auto& [code, meaning] : exit_codes()) text += fmt::format("  {:>2}  {}\n", code, meaning);
  return text + "`peclet VERB --help` says more about a verb, `peclet manual VERB | man -l -` all there is.";
}

// One function a verb: its options and its help.
class Reader {
 public:
  Reader() {
    app_.require_subcommand(1);
    app_.set_version_flag("--version", std::function<std::string()>(version_text));  // reads the program file
    app_.footer(exit_code_lines());
    app_.formatter(std::make_shared<HelpFormatter>());
    add_init();
    add_validate();
    add_plan();
    add_run();
    add_status();
    add_watch();
    add_explain();
    add_export();
    add_report();
    add_set();
    add_cancel();
    add_retry();
    add_hand_over();
    add_ingest();
    add_task();
    add_backup();
    add_restore();
    add_doctor();
    add_study();
    add_completion();
    add_manual();
  }

  CommandLine read(int argc, char** argv) {
    try {
      app_.parse(argc, argv);
    } catch (const CLI::ParseError& end) {
      if (argc > 1 && !is_verb_or_option(argv[1])) {
        fmt::print(stderr, "peclet: {}: there is no such verb; `peclet --help` lists them{}\n", argv[1],
                   suggestion(argv[1], verbs()));
        return {std::nullopt, exit_usage};
      }
      if (const std::string unknown = unknown_option(argc, argv); !unknown.empty()) {
        fmt::print(stderr, "peclet {}\n", unknown);
        return {std::nullopt, exit_usage};
      }
      return {std::nullopt, app_.exit(end) == 0 ? 0 : exit_usage};
    }
    return {verb_, 0};
  }

  CommandTree tree() const { return describe(app_, examples_); }

 private:
  // Null: there is none of that name.
  const CLI::App* verb_called(const std::string& word) {
    const auto has_name = [&](const CLI::App* verb) { return verb->get_name() == word; };
    const std::vector<CLI::App*> found = app_.get_subcommands(has_name);
    return found.empty() ? nullptr : found.front();
  }

  bool is_verb_or_option(const std::string& word) {
    return word.starts_with("-") || verb_called(word) != nullptr;
  }

  std::vector<std::string> verbs() {
    std::vector<std::string> names;
    for (const CLI::App* verb : app_.get_subcommands([](const CLI::App*) { return true; }))
      names.push_back(verb->get_name());
    return names;
  }

  // "run: --wrokers: there is no such option ...", or nothing when the fault is another one.
  std::string unknown_option(int argc, char** argv) {
    const CLI::App* const verb = argc > 1 ? verb_called(argv[1]) : nullptr;
    if (verb == nullptr) return "";
    std::vector<std::string> names;
    for (const CLI::Option* option : verb->get_options()) {
      for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    }
    for (int place = 2; place < argc; ++place) {
      const std::string word = argv[place];
      const std::string name = word.substr(0, word.find('='));
      if (!name.starts_with("--") || name == "--") continue;
      if (std::find(names.begin(), names.end(), name) != names.end()) continue;
      return fmt::format("{0}: {1}: there is no such option; `peclet {0} --help` lists them{2}",
                         verb->get_name(), name, suggestion(name, names));
    }
    return "";
  }

  CLI::App* add_verb(const char* name, const char* description, const char* example) {
    CLI::App* const verb = app_.add_subcommand(name, description);
    verb->footer(help_footer(name, example));
    examples_[name] = example;
    return verb;
  }

  static void add_file(CLI::App* verb, std::filesystem::path& path) {
    verb->add_option("campaign", path, "Campaign file (JSON)")
        ->required()
        ->type_name(value_name::campaign_file);
  }
  static void add_file_or_folder(CLI::App* verb, std::filesystem::path& path) {
    verb->add_option("campaign", path, "Campaign file, or its .peclet folder")
        ->required()
        ->type_name(value_name::campaign);
  }
  static void add_directory(CLI::App* verb, std::filesystem::path& path) {
    verb->add_option("--directory", path,
                     "Folder of the campaign's database and checkpoints; NAME.peclet beside "
                     "NAME.json unless given")
        ->type_name(value_name::folder);
  }
  static void add_patience(CLI::App* verb, double& seconds) {
    verb->add_option("--wait", seconds,
                     "Seconds to wait for the process that runs the campaign; 0: not at all")
        ->type_name("SECONDS")
        ->check(CLI::NonNegativeNumber)
        ->capture_default_str();
  }
  static void add_accept_engine(CLI::App* verb, std::string& name) {
    verb->add_option("--accept-engine", name,
                     "Version, or 6 or more digits of the hash, of the engine that is there now: results of "
                     "another one at open points are kept apart");
  }
  static void add_team(CLI::App* verb, RunOptions& run) {
    verb->add_option("--workers", run.workers, "Engine processes; cores / threads unless given")
        ->check(CLI::Range(1, 100'000));
    verb->add_option("--threads", run.threads, "Threads of each; 1, or cores / workers, unless given")
        ->check(CLI::Range(1, 4096));
  }
  // The verb that was named becomes the command.
  template <typename Options>
  void choose(CLI::App* verb, const Options& options) {
    verb->callback([this, &options] { verb_ = options; });
  }

  void add_init() {
    CLI::App* const verb =
        add_verb("init", "Write a small campaign to begin with", "peclet init flow-curve.json");
    verb->add_option("campaign", init_.campaign, "Campaign file (JSON) that is not there yet")
        ->required()
        ->type_name(value_name::campaign_file);
    choose(verb, init_);
  }

  void add_validate() {
    CLI::App* const verb = add_verb("validate", "Check a campaign and all its scenes; writes nothing",
                                    "peclet validate flow-curve.json");
    add_file(verb, validate_.campaign);
    verb->add_flag("--json", validate_.json, "For programs");
    choose(verb, validate_);
  }

  void add_plan() {
    CLI::App* const verb = add_verb(
        "plan", "Say how much work a campaign is: seeds, hours, finish; writes nothing without --pilot",
        "peclet plan flow-curve.json --pilot 4 --workers 8");
    add_file(verb, plan_.run.campaign);
    add_directory(verb, plan_.run.directory);
    verb->add_option("--pilot", plan_.pilot,
                     "Run the first seeds of every point, 4 unless given, which count later as any others; "
                     "predict from them, and store that for `status` to judge")
        ->expected(0, 1)
        ->default_str("4");
    add_team(verb, plan_.run);
    verb->add_flag("--quiet", plan_.run.quiet, "No progress on stderr");
    verb->add_flag("--force", plan_.run.force, "Use a network file system all the same, at your own risk");
    verb->add_flag("--json", plan_.json, "For programs");
    choose(verb, plan_);
  }

  void add_run() {
    CLI::App* const verb =
        add_verb("run", "Run a campaign until every point is decided; go on with one that was stopped",
                 "peclet run flow-curve.json --workers 8");
    add_file(verb, run_.campaign);
    add_directory(verb, run_.directory);
    add_team(verb, run_);
    verb->add_option("--time-limit", run_.time_limit, "Seconds after which workers checkpoint and stop")
        ->type_name("SECONDS")
        ->check(CLI::PositiveNumber);
    verb->add_option("--budget", run_.budget_hours,
                     "Hours of processor time that this run may spend, where they lower the summed relative "
                     "error most")
        ->check(CLI::PositiveNumber);
    verb->add_option("--lease", run_.lease_seconds,
                     "Seconds without a new step after which a worker counts as hung")
        ->type_name("SECONDS")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    verb->add_option("--checkpoint", run_.checkpoint_seconds, "Seconds between checkpoints of a realisation")
        ->type_name("SECONDS")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    verb->add_option("--backup", run_.backup_seconds, "Seconds between backups of the database")
        ->type_name("SECONDS")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    verb->add_flag("--jsonl", run_.jsonl,
                   "What happens as JSON on standard output, one object a line, instead of the table");
    add_accept_engine(verb, run_.accept_engine);
    verb->add_flag("--quiet", run_.quiet, "No progress on stderr");
    verb->add_flag("--force", run_.force, "Use a network file system all the same, at your own risk");
    choose(verb, run_);
  }

  void add_status() {
    CLI::App* const verb = add_verb("status", "Show how far every point is, also while it runs",
                                    "peclet status flow-curve.json --check");
    add_file_or_folder(verb, status_.campaign);
    add_directory(verb, status_.directory);
    verb->add_flag("--json", status_.json, "For programs");
    verb->add_flag(
        "--check", status_.check,
        "Leave with 0 (every point converged), 3 (decided, but not all converged), 4 (not finished) or "
        "6 (suspect)");
    choose(verb, status_);
  }

  void add_watch() {
    CLI::App* const verb =
        add_verb("watch", "Show the status in a terminal, kept up to date", "peclet watch flow-curve.json");
    add_file_or_folder(verb, watch_.campaign);
    add_directory(verb, watch_.directory);
    verb->add_option("--interval", watch_.interval_seconds, "Seconds between looks")
        ->type_name("SECONDS")
        ->check(CLI::Range(0.1, 86'400.0))
        ->capture_default_str();
    choose(verb, watch_);
  }

  void add_explain() {
    CLI::App* const verb = add_verb("explain", "Say why points are where they are, and what comes next",
                                    "peclet explain flow-curve.json peclet=10");
    add_file_or_folder(verb, explain_.campaign);
    verb->add_option("point", explain_.point,
                     "Label of a point, or 4 or more digits of its hash; all unless given")
        ->type_name("POINT");
    add_directory(verb, explain_.directory);
    verb->add_flag("--json", explain_.json, "For programs");
    choose(verb, explain_);
  }

  void add_export() {
    CLI::App* const verb = add_verb("export", "Print the results for programs to read",
                                    "peclet export flow-curve.json --csv --output flow-curve.csv");
    add_file_or_folder(verb, export_.campaign);
    add_directory(verb, export_.directory);
    CLI::Option* const json = verb->add_flag_callback(
        "--json", [this] { export_.format = ExportFormat::json; }, "Everything, seed by seed (the default)");
    CLI::Option* const csv = verb->add_flag_callback(
        "--csv", [this] { export_.format = ExportFormat::csv; }, "One row per point");
    csv->excludes(json);
    verb->add_flag("--canonical", export_.canonical,
                   "Only what depends on campaign, seeds and engine: equal runs give equal bytes");
    verb->add_option("--output", export_.output,
                     "File to write, whole or not at all; standard output unless given")
        ->type_name(value_name::file);
    choose(verb, export_);
  }

  void add_report() {
    CLI::App* const verb =
        add_verb("report", "Make one HTML page of a campaign, for a colleague or a notebook",
                 "peclet report flow-curve.json --output flow-curve.html");
    add_file_or_folder(verb, report_.campaign);
    add_directory(verb, report_.directory);
    verb->add_option("--output", report_.output,
                     "File to write, whole or not at all; standard output unless given")
        ->type_name(value_name::file);
    choose(verb, report_);
  }

  void add_set() {
    CLI::App* const verb =
        add_verb("set", "Change target, points or priorities of a campaign, also while it runs",
                 "peclet set flow-curve.json --tolerance 0.03 --maximum 2000");
    add_file(verb, set_.campaign);
    add_directory(verb, set_.directory);
    verb->add_option("--tolerance", set_.tolerance, "/target/relative_tolerance; 5 % is written 0.05");
    verb->add_option("--confidence", set_.confidence, "/target/confidence");
    verb->add_option("--minimum", set_.minimum, "/realisations/minimum: seeds before the first look");
    verb->add_option("--maximum", set_.maximum, "/realisations/maximum: seeds after which a point is capped");
    verb->add_option("--point", set_.points, "Point that is to have the priority; may be repeated")
        ->allow_extra_args(false);
    verb->add_option("--priority", set_.priority, "Points of a higher one are served first; 0 unless set")
        ->check(CLI::Range(-1'000'000, 1'000'000));
    add_patience(verb, set_.patience);
    choose(verb, set_);
  }

  void add_cancel() {
    CLI::App* const verb = add_verb("cancel", "Give points no more seeds, also while the campaign runs",
                                    "peclet cancel flow-curve.json peclet=10");
    add_file_or_folder(verb, cancel_.campaign);
    verb->add_option("point", cancel_.points, "Labels of points, or 4 or more digits of their hashes")
        ->required();
    add_directory(verb, cancel_.directory);
    verb->add_flag("--undo", cancel_.undo, "Take them up again");
    add_patience(verb, cancel_.patience);
    choose(verb, cancel_);
  }

  void add_retry() {
    CLI::App* const verb = add_verb("retry", "Queue seeds again that were given up, with a clean record",
                                    "peclet retry flow-curve.json peclet=10 --seed 17");
    add_file_or_folder(verb, retry_.campaign);
    verb->add_option("point", retry_.points,
                     "Labels of points, or 4 or more digits of their hashes; all unless given");
    add_directory(verb, retry_.directory);
    verb->add_option("--seed", retry_.seeds,
                     "Of the one point that is named; may be repeated; all unless given")
        ->allow_extra_args(false)
        ->check(CLI::NonNegativeNumber);
    add_patience(verb, retry_.patience);
    choose(verb, retry_);
  }

  void add_hand_over() {
    CLI::App* const verb =
        add_verb("hand-over", "Give seeds to a batch system: job arrays that need no database and no daemon",
                 "peclet hand-over slurm flow-curve.json --shared /scratch/me/flow-curve --follow \\\n"
                 "           --option=--partition=short --option=--time=4:00:00");
    verb->add_option("system", hand_over_.system, "slurm; with --template any name")
        ->required()
        ->type_name("SYSTEM");
    add_file(verb, hand_over_.campaign);
    add_directory(verb, hand_over_.directory);
    verb->add_option("--shared", hand_over_.shared,
                     "Folder that this machine and the nodes see in the same place; that of the last time "
                     "unless given")
        ->type_name(value_name::folder);
    verb->add_option("--seeds-per-task", hand_over_.seeds_per_task,
                     "Seeds that one task runs, one after another")
        ->check(CLI::Range(1, 100'000))
        ->capture_default_str();
    verb->add_option("--largest-array", hand_over_.largest_array,
                     "Tasks of one job at most; what the batch system allows unless given")
        ->check(CLI::Range(1, 1'000'000));
    verb->add_option("--threads", hand_over_.threads, "Threads of each engine")
        ->check(CLI::Range(1, 4096))
        ->capture_default_str();
    verb->add_option("--option", hand_over_.options, "Word for the submit command (sbatch)")
        ->type_name("WORD");
    verb->add_option("--template", hand_over_.template_folder,
                     "Folder with job.sh and the commands, for other sites")
        ->type_name(value_name::folder)
        ->check(CLI::ExistingDirectory);
    verb->add_flag("--ahead", hand_over_.ahead, "Hand over the seeds of the look after the next one, too");
    verb->add_flag("--follow", hand_over_.follow,
                   "Take results in and hand over what the next looks need, until every point is decided");
    verb->add_option("--interval", hand_over_.interval, "Seconds between two turns of --follow")
        ->type_name("SECONDS")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    verb->add_option("--lease", hand_over_.lease_seconds,
                     "Seconds without a new step after which an engine counts as hung")
        ->type_name("SECONDS")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    verb->add_option("--checkpoint", hand_over_.checkpoint_seconds,
                     "Seconds between checkpoints of a realisation")
        ->type_name("SECONDS")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    add_accept_engine(verb, hand_over_.accept_engine);
    verb->add_flag("--dry-run", hand_over_.dry_run, "Say what would be handed over; submit nothing");
    verb->add_flag("--quiet", hand_over_.quiet, "No progress on stderr");
    verb->add_flag("--force", hand_over_.force, "Use a network file system for the database all the same");
    choose(verb, hand_over_);
  }

  void add_ingest() {
    CLI::App* const verb =
        add_verb("ingest", "Take in what a batch system has done with the seeds it was given",
                 "peclet ingest flow-curve.json");
    add_file(verb, ingest_.campaign);
    add_directory(verb, ingest_.directory);
    verb->add_flag("--cancel", ingest_.cancel, "End the jobs and take their seeds back");
    verb->add_flag("--quiet", ingest_.quiet, "No notes on stderr");
    verb->add_flag("--force", ingest_.force, "Use a network file system for the database all the same");
    choose(verb, ingest_);
  }

  void add_task() {
    CLI::App* const verb = add_verb("task", "Run one task of a bundle; what job scripts call on a node",
                                    "peclet task /scratch/me/flow-curve/bundles/NAME/manifest.json 7");
    verb->add_option("manifest", task_.manifest, "The bundle's manifest.json")
        ->required()
        ->type_name(value_name::campaign_file);
    verb->add_option("index", task_.index, "Number of the task, from 0")
        ->required()
        ->check(CLI::NonNegativeNumber);
    choose(verb, task_);
  }

  void add_backup() {
    CLI::App* const verb = add_verb("backup", "Copy a campaign's database, checked, also while it runs",
                                    "peclet backup flow-curve.json /mnt/usb/flow-curve --checkpoints");
    add_file_or_folder(verb, backup_.campaign);
    verb->add_option(
            "target", backup_.target,
            "Folder for backup.db; the backup there before becomes backup.previous.db; the campaign's "
            "own backup/ unless given")
        ->type_name(value_name::folder);
    add_directory(verb, backup_.directory);
    verb->add_flag("--checkpoints", backup_.checkpoints,
                   "With checkpoints and spool, so that seeds that run now need not start again");
    verb->add_flag("--json", backup_.json, "For programs");
    choose(verb, backup_);
  }

  void add_restore() {
    CLI::App* const verb =
        add_verb("restore", "Put a backup in the place of a lost or damaged database, here or elsewhere",
                 "peclet restore /mnt/usb/flow-curve flow-curve.json");
    verb->add_option("backup", restore_.backup, "Folder of backups, or one file")
        ->required()
        ->type_name(value_name::file);
    verb->add_option("campaign", restore_.campaign,
                     "Campaign file or .peclet folder; made when there is none")
        ->required()
        ->type_name(value_name::campaign);
    add_directory(verb, restore_.directory);
    verb->add_flag(
        "--force", restore_.force,
        "Also in the place of a sound database that is as new, or another campaign's; it is kept aside");
    choose(verb, restore_);
  }

  void add_doctor() {
    CLI::App* const verb =
        add_verb("doctor", "Examine a campaign: database, files, processes, clock and disk",
                 "peclet doctor flow-curve.json --repair");
    add_file_or_folder(verb, doctor_.campaign);
    add_directory(verb, doctor_.directory);
    verb->add_flag("--repair", doctor_.repair, "Do the safe repairs that are named as cures");
    verb->add_flag("--json", doctor_.json, "For programs");
    choose(verb, doctor_);
  }

  void add_study() {
    CLI::App* const verb = add_verb("study", "List the studies of published statements, or make one again",
                                    "peclet study pair-potential --quick");
    CLI::Option* const name =
        verb->add_option("study", study_.name, "Which; the list unless given")->type_name("STUDY");
    verb->add_flag("--list", study_.list, "List them with their verdicts, as without a name")->excludes(name);
    verb->add_flag("--quick", study_.quick, "Half a minute of it, which fails where the physics is broken")
        ->needs(name);
    verb->add_flag("--json", study_.json, "The list, for programs")->excludes(name);
    verb->add_option(
            "--folder", study_.folder,
            "Folder of the study's campaigns, with which a second call goes on; a temporary one unless "
            "given")
        ->type_name(value_name::folder)
        ->needs(name);
    verb->add_option("--results", study_.results,
                     "Folder of the studies; that of the source tree unless given")
        ->type_name(value_name::folder);
    choose(verb, study_);
  }

  void add_completion() {
    CLI::App* const verb =
        add_verb("completion", "Print a script with which a shell completes verbs, options and files",
                 "eval \"$(peclet completion bash)\"");
    verb->add_option("shell", completion_.shell, "The shell")
        ->required()
        ->type_name("SHELL")
        ->check(CLI::IsMember({"bash", "zsh", "fish"}));
    verb->add_option("--output", completion_.output,
                     "File to write, whole or not at all; standard output unless given")
        ->type_name(value_name::file);
    choose(verb, completion_);
  }

  void add_manual() {
    CLI::App* const verb =
        add_verb("manual", "Print a page of the manual for man(1)", "peclet manual run | man -l -");
    CLI::Option* const name =
        verb->add_option("verb", manual_.verb, "Which; that of peclet itself unless given")
            ->type_name("VERB");
    verb->add_option("--folder", manual_.folder, "Folder to write all pages to")
        ->type_name(value_name::folder)
        ->check(CLI::ExistingDirectory)
        ->excludes(name);
    choose(verb, manual_);
  }

  CLI::App app_{"Campaigns of dense-suspension simulations: from a scene to converged averages", "peclet"};
  std::optional<Verb> verb_;
  std::map<std::string, std::string> examples_;
  InitOptions init_;
  ValidateOptions validate_;
  PlanOptions plan_;
  RunOptions run_;
  StatusOptions status_;
  WatchOptions watch_;
  ExplainOptions explain_;
  ExportOptions export_;
  ReportOptions report_;
  SetOptions set_;
  CancelOptions cancel_;
  RetryOptions retry_;
  HandOverOptions hand_over_;
  IngestOptions ingest_;
  TaskOptions task_;
  BackupOptions backup_;
  RestoreOptions restore_;
  DoctorOptions doctor_;
  StudyOptions study_;
  CompletionOptions completion_;
  ManualOptions manual_;
};

}  // namespace

CommandLine read_command_line(int argc, char** argv) { return Reader().read(argc, argv); }

CommandTree command_tree() { return Reader().tree(); }

}  // namespace peclet::runner
