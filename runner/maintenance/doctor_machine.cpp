// Examines whether the machine is fit for the campaign: processes, clock, disk.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <sstream>

#include "runner/campaign/quoting.h"
#include "runner/engines/worker_process.h"
#include "runner/maintenance/doctor.h"
#include "runner/store/backups.h"
#include "runner/store/database_summary.h"

namespace peclet::runner {
namespace {

std::string content(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

// Returns a variable of the environment that a process was started with, which NUL characters divide.
std::string variable_of(const std::string& environment, const std::string& name) {
  std::istringstream entries(environment);
  for (std::string entry; std::getline(entries, entry, '\0');) {
    if (entry.starts_with(name + "=")) return entry.substr(name.size() + 1);
  }
  return "";
}

std::string command_of(const fs::path& process) {
  std::string words = content(process / "cmdline");
  std::replace(words.begin(), words.end(), '\0', ' ');
  while (words.ends_with(' ')) words.pop_back();
  return words;
}

// Returns the folders of all processes, in /proc.
std::vector<fs::path> processes() {
  std::vector<fs::path> found;
  for (const fs::directory_entry& entry : fs::directory_iterator("/proc")) {
    const std::string name = entry.path().filename().string();
    if (name.find_first_not_of("0123456789") == std::string::npos) found.push_back(entry.path());
  }
  return found;
}

// Returns the other processes that have the database open: "process 4711 (peclet watch), which is stopped".
std::vector<std::string> readers_of(const fs::path& database, const std::string& owner) {
  std::error_code error;
  const fs::path file = fs::canonical(database, error);
  std::vector<std::string> readers;
  for (const fs::path& process : processes()) {
    const std::string number = process.filename().string();
    if (number == owner || number == std::to_string(getpid())) continue;
    for (fs::directory_iterator open(process / "fd", error), end; !error && open != end;
         open.increment(error)) {
      std::error_code gone;
      if (fs::read_symlink(open->path(), gone) != file) continue;
      // The state follows the name, which is in parentheses.
      const std::string about = content(process / "stat");
      const std::size_t name_end = about.rfind(')');
      const bool is_stopped = name_end != std::string::npos && about.substr(name_end, 4) == ") T ";
      readers.push_back(fmt::format("process {} ({}){}", number, plain(command_of(process), 80),
                                    is_stopped ? ", which is stopped" : ""));
      break;
    }
  }
  return readers;
}

struct RoomNeeded {
  std::uintmax_t bytes = 0, files = 0;
};

// Returns the room that the seeds of the next stop tests need: their rows, two backups and a third that is
// being made, and a checkpoint and a result in flight for each that runs at a time.
RoomNeeded still_needed(Database& database, const CampaignDirectory& directory) {
  const std::int64_t results = extent_of(database.connection()).results;
  const std::uintmax_t size = fs::file_size(directory.database());
  const std::uintmax_t each = results > 0 ? size / static_cast<std::uintmax_t>(results) : 1 << 14;
  const TargetRecord target = database.campaign().target;
  std::uintmax_t seeds = 0;
  for (const PointRecord& point : database.points()) {
    const std::vector<StopTestRecord> stop_tests = database.stop_tests(point.id);
    if (!stop_tests.empty() && stop_tests.back().stop_test.verdict != Verdict::more) continue;
    const int ended = database.counts(point.id).terminal();
    // The next stop test is certain to be needed.
    const int wanted = stop_tests.empty() ? target.minimum : stop_tests.back().stop_test.seeds * 5 / 4 + 1;
    seeds += static_cast<std::uintmax_t>(std::max(0, std::min(wanted, target.maximum) - ended));
  }
  std::uintmax_t checkpoint = 0;
  if (fs::is_directory(directory.checkpoints())) {
    for (const fs::directory_entry& entry : fs::directory_iterator(directory.checkpoints())) {
      std::error_code gone;
      const std::uintmax_t bytes = entry.file_size(gone);
      if (!gone) checkpoint = std::max(checkpoint, bytes);
    }
  }
  const auto workers = static_cast<std::uintmax_t>(usable_cores());
  return {seeds * each * 4 + size + workers * (2 * checkpoint + each), 2 * workers + 16};
}

}  // namespace

void examine_processes(const CampaignUnderExamination& examined, Findings& findings) {
  const std::string owner = examined.owner ? std::to_string(*examined.owner) : "";
  for (const fs::path& process : processes()) {
    const std::string number = process.filename().string();
    // Processes of other users cannot be read, and are not ours.
    const std::string environment = content(process / "environ");
    if (variable_of(environment, "PECLET_CAMPAIGN") != examined.directory.root().string()) continue;
    const std::string theirs = variable_of(environment, "PECLET_OWNER");
    const std::string command = command_of(process);
    if (theirs == owner || command.empty()) continue;
    findings.push_back(
        {"orphaned-worker", Severity::warning,
         fmt::format("process {} ({}) was started by process {}, which no longer owns this campaign", number,
                     command, theirs),
         fmt::format("it should leave by itself within a minute; if not: kill {}", number)});
  }
}

void examine_clock(Database& database, const CampaignUnderExamination& examined, Findings& findings) {
  const auto [backwards, negative, future] = clock_faults(database, examined.now);
  const std::string harmless =
      "no decision is made from wall-clock times; set the clock (NTP) for the sake of readers";
  if (backwards + negative > 0) {
    findings.push_back(
        {"clock-backwards", Severity::note,
         fmt::format("the wall clock went backwards: {} events are earlier than the one before, {} "
                     "attempts end before they begin",
                     backwards, negative),
         harmless});
  }
  if (future > 0) {
    findings.push_back({"clock-ahead", Severity::warning,
                        fmt::format("{} events and attempts are later than now, {}", future, examined.now),
                        harmless});
  }
}

// While a reader uses an earlier state of the database, SQLite cannot begin its log anew, and the log grows.
void examine_log(const CampaignUnderExamination& examined, Findings& findings) {
  constexpr std::uintmax_t large = 32 << 20;  // far more than checkpoints in time let it become
  std::error_code absent;
  const std::uintmax_t size = fs::file_size(examined.directory.database().string() + "-wal", absent);
  if (absent || size < large) return;
  const std::string owner = examined.owner ? std::to_string(*examined.owner) : "";
  const std::vector<std::string> readers = readers_of(examined.directory.database(), owner);
  findings.push_back(
      {"log-large", Severity::warning,
       fmt::format(
           "the database's write-ahead log has {:.0f} MB: a process reads an earlier state and does not "
           "finish{}{}",
           1e-6 * static_cast<double>(size), readers.empty() ? "" : "; it is open in ",
           fmt::join(readers, ", ")),
       readers.empty()
           ? "the owner's next commits make it small again"
           : "let that process continue (kill -CONT) or end it; the log then becomes small by itself"});
}

void examine_disk(Database& database, const CampaignUnderExamination& examined, Findings& findings) {
  const fs::path& root = examined.directory.root();
  if (const std::optional<std::string> kind = network_file_system(root)) {
    findings.push_back({"network-file-system", Severity::warning,
                        fmt::format("the campaign is on {}, where locks and fsync cannot be trusted", *kind),
                        "move it with `peclet backup` and `peclet restore` to a local disk"});
  } else if (const std::string doubt = doubt_about_file_system(root); !doubt.empty()) {
    findings.push_back(
        {"network-file-system", Severity::warning, doubt,
         "move it with `peclet backup` and `peclet restore` if more than one machine uses it"});
  }
  struct statvfs about {};
  if (statvfs(root.c_str(), &about) != 0) return;
  const std::uintmax_t free = std::uintmax_t{about.f_bavail} * about.f_frsize;
  const RoomNeeded expected = still_needed(database, examined.directory);
  if (free < expected.bytes) {
    findings.push_back(
        {"disk-short", Severity::warning,
         fmt::format("{:.1f} MB are free, and the campaign may need {:.1f} MB until its next stop tests",
                     1e-6 * static_cast<double>(free), 1e-6 * static_cast<double>(expected.bytes)),
         "make room; a run waits when the disk is full, and loses nothing"});
  }
  if (about.f_files > 0 && about.f_favail < expected.files) {
    findings.push_back({"inodes-short", Severity::warning,
                        fmt::format("{} files can still be made, and the campaign needs about {} at a time",
                                    static_cast<std::uintmax_t>(about.f_favail), expected.files),
                        "remove files on this file system"});
  }
}

}  // namespace peclet::runner
