#include "runner/care/doctor.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>

#include "contract/exit_codes.h"
#include "contract/guarded_file.h"
#include "runner/care/restore.h"
#include "runner/owner/open_campaign.h"
#include "runner/store/backups.h"
#include "runner/store/locks.h"
#include "runner/text/number_text.h"

namespace peclet::runner {
namespace {

namespace fs = std::filesystem;

const char* name_of(Severity severity) {
  switch (severity) {
    case Severity::integrity:
      return "integrity";
    case Severity::warning:
      return "warning";
    case Severity::note:
      break;
  }
  return "note";
}

// A damaged database cannot be asked anything more.
void examine_database(const CampaignUnderExamination& examined, Findings& findings) {
  const auto damaged = [&](const std::string& message) {
    std::string cure = restore_hint(examined.directory);
    cure = cure.empty() ? "there is no backup; keep the folder, and try `sqlite3 campaign.db .recover`"
                        : cure.substr(2);
    findings.push_back({"database-damaged", Severity::integrity, message, cure});
  };
  try {
    Database database = Database::open_reader(examined.directory.database());
    if (const std::string found = damage(database.connection()); !found.empty()) return damaged(found);
    examine_results(database, examined, findings);
    examine_looks(database, findings);
    examine_states(database, examined, findings);
    examine_files(database, examined, findings);
    examine_left_files(database, examined, findings);
    examine_backups(database, examined, findings);
    examine_hand_over(database, examined, findings);
    examine_clock(database, examined, findings);
    examine_log(examined, findings);
    examine_disk(database, examined, findings);
  } catch (const IntegrityError& error) {
    damaged(error.what());
  }
}

void repair(const CampaignDirectory& directory, Findings& findings) {
  const auto can = [](const Finding& finding) { return static_cast<bool>(finding.repair); };
  if (std::none_of(findings.begin(), findings.end(), can)) return;
  create_folders(directory);
  Database owner = Database::open_owner(directory.database());
  for (Finding& finding : findings) {
    if (!finding.repair) continue;
    finding.repair(owner);
    finding.repaired = true;
  }
}

int exit_code(const Findings& findings) {
  Severity worst = Severity::note;
  for (const Finding& finding : findings) {
    if (!finding.repaired) worst = std::max(worst, finding.severity);
  }
  if (worst == Severity::integrity) return ExitCode::integrity;
  return worst == Severity::warning ? ExitCode::error : ExitCode::done;
}

std::string as_text(const CampaignUnderExamination& examined, const Findings& findings) {
  const auto is_note = [](const Finding& finding) { return finding.severity == Severity::note; };
  const auto notes = static_cast<std::size_t>(std::count_if(findings.begin(), findings.end(), is_note));
  const bool is_sound = notes == findings.size();
  std::string text = fmt::format("{}: {}{}\n", examined.directory.root().string(),
                                 is_sound ? "sound" : counted(findings.size() - notes, "finding"),
                                 notes == 0 ? "" : ", " + counted(notes, "note"));
  for (const Finding& finding : findings) {
    text += fmt::format("\n{}: {}\n", name_of(finding.severity), finding.message);
    if (!finding.cure.empty())
      text += fmt::format("  {}: {}\n", finding.repaired ? "done" : "cure", finding.cure);
  }
  return text;
}

std::string as_json(const CampaignUnderExamination& examined, const Findings& findings) {
  Json list = Json::array();
  for (const Finding& finding : findings) {
    list.push_back({{"code", finding.code},
                    {"severity", name_of(finding.severity)},
                    {"message", finding.message},
                    {"cure", finding.cure},
                    {"repairable", static_cast<bool>(finding.repair)},
                    {"repaired", finding.repaired}});
  }
  return Json{{"schema_version", 1},
              {"folder", examined.directory.root().string()},
              {"owner", examined.owner ? Json(*examined.owner) : Json(nullptr)},
              {"standing", exit_code(findings)},
              {"findings", list}}
             .dump(2) +
         "\n";
}

}  // namespace

Diagnosis examine_campaign(const DoctorOptions& options) {
  const CampaignDirectory directory = find_campaign(options.campaign, options.directory);
  std::unique_ptr<OwnerLock> lock;
  if (options.repair) lock = std::make_unique<OwnerLock>(directory);
  const auto now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  const CampaignUnderExamination examined{directory, lock ? std::nullopt : current_owner(directory),
                                          fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(now))};
  Findings findings;
  if (!kind_of(directory.database()).empty()) {
    examine_database(examined, findings);
  } else {
    findings.push_back({"database-gone", Severity::integrity, "there is no " + directory.database().string(),
                        restore_hint(directory).substr(2)});
  }
  examine_processes(examined, findings);
  if (options.repair) repair(directory, findings);
  return {options.json ? as_json(examined, findings) : as_text(examined, findings), exit_code(findings)};
}

}  // namespace peclet::runner
