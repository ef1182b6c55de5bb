// Verbs that keep a campaign safe and sound.
#include <memory>

#include "runner/command_line/verb_set.h"

namespace peclet::runner {
namespace {

void add_backup(VerbSet& verbs) {
  const auto options = std::make_shared<BackupOptions>();
  CLI::App* const verb =
      verbs.add("backup", "Copy a campaign's database and files, checked, also while it runs",
                "peclet backup flow-curve.json /mnt/usb/flow-curve --checkpoints");
  add_file_or_folder(verb, options->campaign);
  verb->add_option("target", options->target,
                   "Folder for backup.db, made in one that must be there; the backup there before becomes "
                   "backup.previous.db; the campaign's own backup/ unless given")
      ->type_name(value_name::folder);
  add_directory(verb, options->directory);
  verb->add_flag("--checkpoints", options->checkpoints,
                 "With checkpoints and spool, so that seeds that run now need not start again");
  verb->add_flag("--json", options->json, "For programs");
  verbs.choose(verb, options);
}

void add_restore(VerbSet& verbs) {
  const auto options = std::make_shared<RestoreOptions>();
  CLI::App* const verb =
      verbs.add("restore", "Put a backup in the place of a lost or damaged database, here or elsewhere",
                "peclet restore /mnt/usb/flow-curve flow-curve.json");
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
  verbs.choose(verb, options);
}

void add_doctor(VerbSet& verbs) {
  const auto options = std::make_shared<DoctorOptions>();
  CLI::App* const verb = verbs.add("doctor", "Examine a campaign: database, files, processes, clock and disk",
                                   "peclet doctor flow-curve.json --repair");
  add_file_or_folder(verb, options->campaign);
  add_directory(verb, options->directory);
  verb->add_flag("--repair", options->repair, "Do the safe repairs that are named as cures");
  verb->add_flag("--json", options->json, "For programs");
  verbs.choose(verb, options);
}

}  // namespace

void add_keeping_verbs(VerbSet& verbs) {
  add_backup(verbs);
  add_restore(verbs);
  add_doctor(verbs);
}

}  // namespace peclet::runner
