// Examines whether the files of a campaign belong to it, and whether there are backups.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <utility>

#include "contract/guarded_file.h"
#include "runner/campaign/number_text.h"
#include "runner/campaign/quoting.h"
#include "runner/maintenance/backup.h"
#include "runner/maintenance/doctor.h"
#include "runner/owner/request.h"
#include "runner/store/backups.h"
#include "runner/store/result_files.h"

namespace peclet::runner {
namespace {

constexpr std::array known_names{"campaign.db",
                                 "campaign.db-wal",
                                 "campaign.db-shm",
                                 "campaign.db-journal",
                                 "campaign.lock",
                                 "spool",
                                 "checkpoints",
                                 "failures",
                                 "logs",
                                 "backup",
                                 "aside",
                                 "campaign.json",
                                 "requests",
                                 "files"};

// A running campaign makes a backup every ten minutes.
constexpr double old_backup_hours = 24;

std::vector<fs::path> files_in(const fs::path& folder) {
  std::vector<fs::path> files;
  if (kind_of(folder) != "a folder") return files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

std::string listed(const std::vector<fs::path>& files) {
  constexpr std::size_t most = 3;
  std::string text;
  for (std::size_t i = 0; i < std::min(most, files.size()); ++i) {
    text += (i == 0 ? "" : ", ") + plain_name(files[i]);
  }
  return files.size() > most ? fmt::format("{} and {} more", text, files.size() - most) : text;
}

double megabytes(const std::vector<fs::path>& files) {
  double bytes = 0;
  for (const fs::path& file : files) {
    std::error_code gone;
    const std::uintmax_t size = fs::file_size(file, gone);
    if (!gone) bytes += static_cast<double>(size);
  }
  return 1e-6 * bytes;
}

void remove_all_of(const std::vector<fs::path>& files) {
  for (const fs::path& file : files) fs::remove(file);
}

enum class Need {
  open,   // its seed may be wanted
  extra,  // its seed lies beyond the stop test that has decided the point
  none    // its seed has ended
};

// True if the seed lies beyond the stop test that has decided the point. The seeds below it have all ended,
// unless one is to be run again.
bool is_extra(const RealisationRecord& record, const std::vector<StopTestRecord>& stop_tests) {
  return !stop_tests.empty() && stop_tests.back().stop_test.verdict != Verdict::more &&
         record.seed >= stop_tests.back().stop_test.seeds;
}

// Returns what each checkpoint is needed for, by its name.
std::map<std::string, Need> checkpoint_names(Database& database, const CampaignDirectory& directory) {
  std::map<std::string, Need> names;
  for (const auto& points : {database.points(), database.inactive_points()}) {
    for (const PointRecord& point : points) {
      if (point.set_aside) continue;  // checkpoints of its scene are of the engine that is used now
      const std::vector<StopTestRecord> stop_tests = database.stop_tests(point.id);
      for (const RealisationRecord& record : database.realisations(point.id)) {
        const Need need = !record.cause.empty()          ? Need::none
                          : is_extra(record, stop_tests) ? Need::extra
                                                         : Need::open;
        names[directory.checkpoint(point.hash, record.seed).filename().string()] = need;
      }
    }
  }
  return names;
}

void examine_checkpoints(Database& database, const CampaignUnderExamination& examined, Findings& findings) {
  const std::map<std::string, Need> names = checkpoint_names(database, examined.directory);
  std::vector<fs::path> ended, extra, rejected, strays;
  for (const fs::path& file : files_in(examined.directory.checkpoints())) {
    const auto seed = names.find(checkpoint_of(file).filename().string());
    if (seed != names.end()) {
      if (seed->second == Need::none) ended.push_back(file);
      if (seed->second == Need::extra) extra.push_back(file);
    } else if (file.filename().string().find(".checkpoint.rejected") != std::string::npos) {
      rejected.push_back(file);
    } else if (file.extension() != ".tmp") {
      strays.push_back(file);
    }
  }
  // While the campaign runs, a worker may be about to remove a checkpoint, or to leave one.
  if (!ended.empty() && !examined.owner) {
    findings.push_back(
        {"checkpoint-left", Severity::note,
         fmt::format("{} checkpoints are of seeds that have ended: {}", ended.size(), listed(ended)),
         "`peclet run` and `peclet doctor --repair` remove them",
         [ended](Database&) { remove_all_of(ended); }});
  }
  if (!extra.empty() && !examined.owner) {
    findings.push_back(
        {"checkpoint-extra", Severity::note,
         fmt::format("{} checkpoints ({:.1f} MB) belong to extra seeds, which their decided points did not "
                     "need: {}",
                     extra.size(), megabytes(extra), listed(extra)),
         "`peclet doctor --repair` removes them; if kept, they save these seeds' time when a tolerance is "
         "tightened",
         [extra](Database&) { remove_all_of(extra); }});
  }
  if (!rejected.empty()) {
    findings.push_back({"checkpoint-rejected", Severity::note,
                        fmt::format("{} checkpoints could not be used and were set aside: {}",
                                    rejected.size(), listed(rejected)),
                        "their seeds started again; `peclet doctor --repair` removes them",
                        [rejected](Database&) { remove_all_of(rejected); }});
  }
  if (!strays.empty()) {
    findings.push_back({"stray-checkpoint", Severity::note,
                        fmt::format("{} files in checkpoints/ belong to no seed of this campaign: {}",
                                    strays.size(), listed(strays)),
                        "move them away if nothing else needs them"});
  }
}

void examine_spool(const CampaignUnderExamination& examined, Findings& findings) {
  const CampaignDirectory& directory = examined.directory;
  if (!fs::is_directory(directory.spool())) return;
  const std::vector<fs::path> waiting = spool_files(directory);
  if (!waiting.empty() && !examined.owner) {
    findings.push_back({"spool-waiting", Severity::note,
                        fmt::format("{} results wait in spool/: {}", waiting.size(), listed(waiting)),
                        "the next `peclet run` takes them in"});
  }
  const std::vector<fs::path> rejected = files_in(directory.rejected());
  if (!rejected.empty()) {
    findings.push_back({"rejected-results", Severity::warning,
                        fmt::format("{} files were turned down: {}", rejected.size(), listed(rejected)),
                        "the table `event` says why; remove them from spool/rejected/ when you know"});
  }
}

void examine_requests(const CampaignUnderExamination& examined, Findings& findings) {
  const std::vector<fs::path> waiting = waiting_requests(examined.directory);
  if (!waiting.empty() && !examined.owner) {
    findings.push_back({"request-waiting", Severity::note,
                        fmt::format("{} requests wait in requests/: {}", waiting.size(), listed(waiting)),
                        "the next `peclet run` carries them out"});
  }
}

void examine_unfinished(const CampaignUnderExamination& examined, Findings& findings) {
  std::vector<fs::path> folders = folders_below(examined.directory), unfinished;
  folders.insert(folders.begin(), examined.directory.root());
  std::erase_if(folders, [](const fs::path& folder) { return !fs::is_directory(folder); });
  for (const fs::path& folder : folders) {
    for (const fs::path& file : unfinished_files(folder)) unfinished.push_back(file);
  }
  if (unfinished.empty()) return;
  findings.push_back({"unfinished-file", Severity::note,
                      fmt::format("{} files were left unfinished by processes that died: {}",
                                  unfinished.size(), listed(unfinished)),
                      "`peclet run` and `peclet doctor --repair` remove them", [folders](Database&) {
                        for (const fs::path& folder : folders) remove_unfinished_files(folder);
                      }});
}

void examine_strays(const CampaignUnderExamination& examined, Findings& findings) {
  std::vector<fs::path> strays;
  for (const fs::path& file : files_in(examined.directory.root())) {
    const std::string name = file.filename().string();
    const bool known = std::find(known_names.begin(), known_names.end(), name) != known_names.end();
    if (!known && file.extension() != ".tmp") strays.push_back(file);
  }
  if (strays.empty()) return;
  findings.push_back({"stray-file", Severity::note,
                      "files that do not belong to the campaign: " + listed(strays),
                      "move them away if nothing else needs them"});
}

// Returns "files/a, files/b, files/c ...": the first of these places, as they lie below `root`.
std::string places_text(const std::vector<fs::path>& places, const fs::path& root) {
  constexpr std::size_t most = 3;
  std::string text;
  for (std::size_t i = 0; i < std::min(most, places.size()); ++i) {
    text += (i == 0 ? "" : ", ") + plain(places[i].lexically_relative(root).string());
  }
  return places.size() > most ? text + " ..." : text;
}

// Reports files that do not match their rows.
void report_faulty(const std::vector<FileRecord>& faulty, const char* code, const char* how,
                   const CampaignDirectory& directory, Findings& findings) {
  if (faulty.empty()) return;
  std::vector<fs::path> places;
  places.reserve(faulty.size());
  for (const FileRecord& record : faulty) places.push_back(record.place(directory));
  Finding finding{code, Severity::warning,
                  fmt::format("{} files that realisations left {}: {}", places.size(), how,
                              places_text(places, directory.root())),
                  "backups made elsewhere have them in files/, by their SHA-256 (view `files`)"};
  const auto is_copied = [&](const FileRecord& record) { return has_copy(record, directory.backup()); };
  if (std::all_of(faulty.begin(), faulty.end(), is_copied)) {
    finding.cure = "`peclet doctor --repair` brings them back from the campaign's own backups";
    finding.repair = [directory](Database& owner) {
      bring_files_back(files_in(owner.connection()), directory, directory.backup());
    };
  }
  findings.push_back(std::move(finding));
}

void examine_places(Database& database, const CampaignUnderExamination& examined, Findings& findings) {
  const CampaignDirectory& directory = examined.directory;
  std::vector<FileRecord> missing, damaged;
  std::set<fs::path> known;
  for (const FileRecord& record : files_in(database.connection())) {
    if (!record.kept) continue;
    const fs::path place = record.place(directory);
    known.insert(place);
    if (is_there(place)) {
      if (!is_sound(record, directory)) damaged.push_back(record);
    } else if (!examined.owner) {  // files of a result that was just committed are on their way
      missing.push_back(record);
    }
  }
  report_faulty(missing, "file-missing", "are not there", directory, findings);
  report_faulty(damaged, "file-damaged", "are not what they were", directory, findings);
  if (examined.owner || kind_of(directory.files()) != "a folder") return;
  std::vector<fs::path> orphans;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(directory.files())) {
    const bool is_folder = entry.symlink_status().type() == fs::file_type::directory;
    if (!is_folder && !known.contains(entry.path())) orphans.push_back(entry.path());
  }
  if (orphans.empty()) return;
  findings.push_back(
      {"file-orphan", Severity::note,
       fmt::format("{} files in files/ belong to no result: {}", orphans.size(),
                   places_text(orphans, directory.root())),
       "their seeds bring them again if the database is an older one; move them away otherwise"});
}

}  // namespace

void examine_files(Database& database, const CampaignUnderExamination& examined, Findings& findings) {
  examine_spool(examined, findings);
  examine_checkpoints(database, examined, findings);
  examine_requests(examined, findings);
  examine_unfinished(examined, findings);
  examine_strays(examined, findings);
}

void examine_backups(Database& database, const CampaignUnderExamination& examined, Findings& findings) {
  const std::int64_t results = extent_of(database.connection()).results;
  if (results == 0) return;
  const fs::path newest = newest_backup(examined.directory.backup());
  const auto find = [&](const std::string& code, const std::string& message) {
    findings.push_back(
        {code, Severity::warning, message, "`peclet backup` and `peclet doctor --repair` make one",
         [directory = examined.directory](Database&) { make_backup(directory, directory.backup(), false); }});
  };
  if (kind_of(newest).empty())
    return find("no-backup", fmt::format("there is no backup of {} results", results));
  try {
    const Contents contents = examine(newest);
    const double hours =
        static_cast<double>(seconds_of_utc(examined.now) - seconds_of_utc(contents.backed_up_at)) / 3600;
    if (contents.results < results && hours > old_backup_hours) {
      find("old-backup", fmt::format("the last backup is {:.0f} hours old and lacks {} results", hours,
                                     results - contents.results));
    }
  } catch (const UnsuitableFile& error) {
    findings.push_back({"backup-damaged", Severity::warning, error.what(),
                        "move it away; `peclet backup` makes another one"});
  } catch (const IntegrityError& error) {
    find("backup-damaged", fmt::format("the last backup is damaged: {}", error.what()));
  }
}

// Examines whether the files that realisations have left are where the database says, and match it.
void examine_left_files(Database& database, const CampaignUnderExamination& examined, Findings& findings) {
  examine_places(database, examined, findings);
  if (examined.owner || kind_of(examined.directory.left()) != "a folder") return;
  std::vector<fs::path> waiting;
  for (const fs::path& file : whole_files(examined.directory.left())) {
    const std::string name = file.filename().string();
    const fs::path result = examined.directory.spool() / (name.substr(0, name.rfind('@')) + ".json");
    if (!is_there(result)) waiting.push_back(file);
  }
  if (waiting.empty()) return;
  findings.push_back({"file-left", Severity::note,
                      fmt::format("{} files belong to attempts that gave no result: {}", waiting.size(),
                                  places_text(waiting, examined.directory.root())),
                      "the next `peclet run` removes them"});
}

}  // namespace peclet::runner
