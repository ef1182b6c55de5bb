// Verbs that keep a campaign safe and sound.
#include <memory>

#include "runner/care/backup.h"
#include "runner/care/doctor.h"
#include "runner/care/restore.h"
#include "runner/command_line/print.h"
#include "runner/command_line/verb_set.h"

namespace peclet::runner {
namespace {

void add_backup(VerbSet& verbs) {
  const auto options = std::make_shared<BackupOptions>();
  CLI::App* const verb =
      verbs.add("backup", "Copy a campaign's database and files, checked, also while it runs",
                "peclet backup flow-curve.json /mnt/usb/flow-curve --checkpoints",
                page(R"(
`peclet run` makes such backups by itself; this makes one now, or elsewhere. The copy is checked before
it takes the place of the one before. Of the folder's path only the last part is made: where a disk is
not mounted, there is an error and no copy on another disk. A copy that turns out to be on the campaign's
own file system is said to be.
)",
                     {}, {0, 1, 2, 6}));
  add_file_or_folder(verb, options->campaign);
  verb->add_option("target", options->target,
                   "Folder for backup.db, made in one that must be there; the backup there before becomes "
                   "backup.previous.db; the campaign's own backup/ unless given")
      ->type_name(value_name::folder);
  add_directory(verb, options->directory);
  verb->add_flag("--checkpoints", options->checkpoints,
                 "With checkpoints and spool, so that seeds that run now need not start again");
  verb->add_flag("--json", options->json, "For programs");
  verbs.choose(verb, options, [](const BackupOptions& given) { print(backup_campaign(given)); });
}

void add_restore(VerbSet& verbs) {
  const auto options = std::make_shared<RestoreOptions>();
  CLI::App* const verb =
      verbs.add("restore", "Put a backup in the place of a lost or damaged database, here or elsewhere",
                "peclet restore /mnt/usb/flow-curve flow-curve.json",
                page(R"(
What was there is kept aside. The campaign then goes on with `peclet run` to the same results.
)",
                     {}, {0, 1, 2, 5, 6}));
  verb->add_option("backup", options->backup, "Folder of backups, or one file")
      ->required()
      ->type_name(value_name::file);
  verb->add_option("campaign", options->campaign, "Campaign file or .peclet folder; made when there is none")
      ->required()
      ->type_name(value_name::campaign);
  add_directory(verb, options->directory);
  verb->add_flag(
      "--force", options->force,
      "Also in the place of a sound database that is as new, or another campaign's; it is kept aside");
  verbs.choose(verb, options, [](const RestoreOptions& given) { print(restore_campaign(given)); });
}

int diagnose(const DoctorOptions& options) {
  const Diagnosis diagnosis = examine_campaign(options);
  print(diagnosis.text);
  return diagnosis.exit_code;
}

void add_doctor(VerbSet& verbs) {
  const auto options = std::make_shared<DoctorOptions>();
  CLI::App* const verb = verbs.add("doctor", "Examine a campaign: database, files, processes, clock and disk",
                                   "peclet doctor flow-curve.json --repair",
                                   page(R"(
Says what is wrong, how bad it is and what cures it. Without --repair nothing is changed. With it, among
other things, checkpoints of seeds that no point needs any more are removed: they cost their time again
should the tolerance be tightened.
)",
                                        {}, {0, 1, 2, 5, 6}));
  add_file_or_folder(verb, options->campaign);
  add_directory(verb, options->directory);
  verb->add_flag("--repair", options->repair, "Do the safe repairs that are named as cures");
  verb->add_flag("--json", options->json, "For programs");
  verbs.choose(verb, options, diagnose);
}

}  // namespace

void add_keeping_verbs(VerbSet& verbs) {
  add_backup(verbs);
  add_restore(verbs);
  add_doctor(verbs);
}

}  // namespace peclet::runner
