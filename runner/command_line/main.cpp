// peclet: campaigns of realisations, from scenes to converged averages.
#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <exception>
#include <system_error>

#include "contract/output_file.h"
#include "runner/command_line/options.h"
#include "runner/folder/owner_lock.h"
#include "runner/owner/open_campaign.h"
#include "runner/verbs/exit_code.h"
#include "runner/verbs/plan_campaign.h"

namespace {

using namespace peclet::runner;

// A full disk behind `peclet export > file` must not look like success.
void print(const std::string& text, const char* advice = "") {
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0) {
    throw std::system_error(errno, std::generic_category(), fmt::format("standard output{}", advice));
  }
}

// What cannot be said, because standard error is closed or full, changes no exit code.
void say(const std::string& text) { std::fputs(text.c_str(), stderr); }

int perform(const InitOptions& options) {
  print(init_campaign(options));
  return 0;
}

int perform(const ValidateOptions& options) {
  print(validate_campaign(options));
  return 0;
}

int perform(const PlanOptions& options) { return plan_campaign(options); }

int perform(const RunOptions& options) { return run_campaign(options); }

int perform(const StatusOptions& options) {
  OpenCampaign open = open_campaign(options.campaign, options.directory);
  CampaignStatus status = read_status(open.database);
  status.owner = current_owner(open.directory);
  print(options.json ? status_json(status).dump(2) + '\n' : status_table(status) + workers_text(status));
  if (const std::string note = difference_from_file(options.campaign, options.directory, status.campaign);
      !note.empty()) {
    say(fmt::format("note: {}\n", note));
  }
  return options.check ? standing(status) : 0;
}

int perform(const WatchOptions& options) { return watch_campaign(options); }

int perform(const ExplainOptions& options) {
  OpenCampaign open = open_campaign(options.campaign, options.directory);
  print(options.json ? explain_json(open.database, open.directory, options.point).dump(2) + '\n'
                     : explain(open.database, open.directory, options.point));
  return 0;
}

// Where --output says, or to standard output.
int deliver(const std::string& text, const std::filesystem::path& output, bool quiet) {
  if (output.empty()) {
    print(text, " (the campaign is as it was; --output FILE writes a file whole or not at all)");
    return 0;
  }
  peclet::write_output(output, text);
  if (!quiet) say(fmt::format("peclet: {} is written, {} bytes\n", output.string(), text.size()));
  return 0;
}

int perform(const ExportOptions& options) {
  OpenCampaign open = open_campaign(options.campaign, options.directory);
  const auto text = [&] {
    switch (options.format) {
      case ExportFormat::json:
        return export_json(open.database, options.canonical);
      case ExportFormat::csv:
        return export_csv(open.database, options.canonical);
      case ExportFormat::long_csv:
        return export_long_csv(open.database);
    }
    return std::string();
  };
  return deliver(text(), options.output, options.quiet);
}

int perform(const ResultsOptions& options) {
  OpenCampaign open = open_campaign(options.campaign, options.directory);
  for_each_result_line(open.database, options.point, options.seed,
                       [](const std::string& line) { print(line + '\n'); });
  return 0;
}

int perform(const ReportOptions& options) {
  OpenCampaign open = open_campaign(options.campaign, options.directory);
  return deliver(report_html(open.database), options.output, options.quiet);
}

int perform(const Reply& reply) {
  print(reply.text);
  return reply.exit_code;
}

int perform(const SetOptions& options) { return perform(set_campaign(options)); }

int perform(const CancelOptions& options) { return perform(cancel_points(options)); }

int perform(const RetryOptions& options) { return perform(retry_seeds(options)); }

int perform(const HandOverOptions& options) { return hand_over_campaign(options); }

int perform(const IngestOptions& options) { return ingest_campaign(options); }

int perform(const TaskOptions& options) { return run_task(options); }

int perform(const BackupOptions& options) {
  print(backup_campaign(options));
  return 0;
}

int perform(const RestoreOptions& options) {
  print(restore_campaign(options));
  return 0;
}

int perform(const DoctorOptions& options) {
  const Diagnosis diagnosis = examine_campaign(options);
  print(diagnosis.text);
  return diagnosis.exit_code;
}

int perform(const StudyOptions& options) { return perform_study(options); }

int perform(const CompletionOptions& options) {
  return deliver(completion(command_tree(), options.shell), options.output, options.quiet);
}

int perform(const ManualOptions& options) {
  if (options.folder.empty()) return deliver(manual_page(command_tree(), options.verb), "", true);
  for (const auto& [name, page] : manual_pages(command_tree())) {
    peclet::write_output(options.folder / name, page);
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const CommandLine command = read_command_line(argc, argv);
    if (!command.verb) return command.exit_code;
    return std::visit([](const auto& options) { return perform(options); }, *command.verb);
  } catch (const std::exception& error) {
    say(fmt::format("peclet: {}\n", message_of(error)));
    return exit_code_of(error);
  }
}
