// The verb `peclet doctor` examines a campaign, and says what cures its faults.
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
  note,      // no fault
  warning,   // something will go wrong, or a person should check it
  integrity  // stored data contradict each other
};

struct Finding {
  std::string code;  // for programs: "checkpoint-left"
  Severity severity = Severity::note;
  std::string message, cure;
  std::function<void(Database& owner)> repair{};  // safe: removes nothing that a run would miss
  bool repaired = false;
};

// The campaign that is examined. Requires that its folder exists.
struct CampaignUnderExamination {
  CampaignDirectory directory;
  std::optional<std::int64_t> owner;  // process that runs it now; absent during repairs
  std::string now;                    // wall-clock time in UTC, as in the database
};

using Findings = std::vector<Finding>;

// Each examines one side (doctor_files.cpp, doctor_machine.cpp). The database is open for reading.
void examine_files(Database& database, const CampaignUnderExamination& examined, Findings& findings);
void examine_left_files(Database& database, const CampaignUnderExamination& examined, Findings& findings);
void examine_backups(Database& database, const CampaignUnderExamination& examined, Findings& findings);
void examine_processes(const CampaignUnderExamination& examined, Findings& findings);
void examine_clock(Database& database, const CampaignUnderExamination& examined, Findings& findings);
void examine_log(const CampaignUnderExamination& examined, Findings& findings);
void examine_disk(Database& database, const CampaignUnderExamination& examined, Findings& findings);

struct Diagnosis {
  std::string text;   // for people, or JSON
  int exit_code = 0;  // 0 sound, 6 integrity, 1 other warnings; repaired findings do not count
};

// Throws InputError if there is no campaign; for repairs OwnedByAnother if a process runs it.
Diagnosis examine_campaign(const DoctorOptions& options);

}  // namespace peclet::runner
