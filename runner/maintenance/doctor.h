// The verb `peclet doctor`: is everything about a campaign in order, and what cures it if not?
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "runner/campaign/paths.h"
#include "runner/store/campaign_directory.h"
#include "runner/store/database.h"

namespace peclet::runner {

struct DoctorOptions {
  fs::path campaign;  // file or folder
  fs::path directory;
  bool repair = false;
  bool json = false;
};

enum class Severity {
  note,      // nothing is wrong
  warning,   // something will go wrong, or somebody should look
  integrity  // what is stored contradicts itself
};

struct Finding {
  std::string code;  // for programs: "checkpoint-left"
  Severity severity = Severity::note;
  std::string message, cure;
  std::function<void(Database& owner)> repair{};  // safe, and undone by nothing that a run would miss
  bool repaired = false;
};

// What is examined. Requires that the campaign's folder exists.
struct CampaignUnderExamination {
  CampaignDirectory directory;
  std::optional<std::int64_t> owner;  // process that runs it now; with repairs, nobody does
  std::string now;                    // wall-clock time in UTC, as in the database
};

using Findings = std::vector<Finding>;

// Each stop tests at one side of it (doctor_files.cpp, doctor_machine.cpp). A reader's database.
void examine_files(Database& database, const CampaignUnderExamination& examined, Findings& findings);
void examine_left_files(Database& database, const CampaignUnderExamination& examined, Findings& findings);
void examine_backups(Database& database, const CampaignUnderExamination& examined, Findings& findings);
void examine_processes(const CampaignUnderExamination& examined, Findings& findings);
void examine_clock(Database& database, const CampaignUnderExamination& examined, Findings& findings);
void examine_log(const CampaignUnderExamination& examined, Findings& findings);
void examine_disk(Database& database, const CampaignUnderExamination& examined, Findings& findings);

struct Diagnosis {
  std::string text;   // for people, or JSON
  int exit_code = 0;  // 0 sound, 6 integrity, 1 other warnings; what was repaired does not count
};

// Throws InputError when there is no campaign, and with `repair` OwnedByAnother when somebody runs it.
Diagnosis examine_campaign(const DoctorOptions& options);

}  // namespace peclet::runner
