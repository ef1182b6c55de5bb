// Are the files that realisations have left where the database says, and are they what it says?
#include <fmt/format.h>

#include <set>
#include <utility>

#include "contract/guarded_file.h"
#include "runner/care/doctor.h"
#include "runner/care/file_copies.h"
#include "runner/store/file_store.h"
#include "runner/store/spool.h"
#include "runner/text/plain_text.h"

namespace peclet::runner {
namespace {

namespace fs = std::filesystem;

class Places {
 public:
  explicit Places(const fs::path& root) : root_(root) {}
  void add(const fs::path& path) {
    constexpr std::size_t most = 3;
    if (++count_ <= most) text_ += (count_ == 1 ? "" : ", ") + plain(path.lexically_relative(root_).string());
    if (count_ == most + 1) text_ += " ...";
  }
  std::size_t count() const { return count_; }
  const std::string& text() const { return text_; }

 private:
  const fs::path& root_;
  std::size_t count_ = 0;
  std::string text_;
};

// Files that are not what their rows say, for whatever reason.
class Faulty {
 public:
  explicit Faulty(const CampaignDirectory& directory) : directory_(directory), places_(directory.root()) {}
  void add(const FileRecord& record) {
    places_.add(record.place(directory_));
    have_copies_ = have_copies_ && has_copy(record, directory_.backup());
  }
  void report(const char* code, const char* how, Findings& findings) const {
    if (places_.count() == 0) return;
    Finding finding{
        code, Severity::warning,
        fmt::format("{} files that realisations left {}: {}", places_.count(), how, places_.text()),
        "backups made elsewhere have them in files/, by their SHA-256 (view `files`)"};
    if (have_copies_) {
      finding.cure = "`peclet doctor --repair` brings them back from the campaign's own backups";
      finding.repair = [directory = directory_](Database& owner) {
        bring_files_back(files_in(owner.connection()), directory, directory.backup());
      };
    }
    findings.push_back(std::move(finding));
  }

 private:
  const CampaignDirectory& directory_;
  Places places_;
  bool have_copies_ = true;
};

void examine_places(Database& database, const CampaignUnderExamination& examined, Findings& findings) {
  const CampaignDirectory& directory = examined.directory;
  Faulty missing(directory), damaged(directory);
  std::set<fs::path> known;
  for (const FileRecord& record : files_in(database.connection())) {
    if (!record.kept) continue;
    const fs::path place = record.place(directory);
    known.insert(place);
    if (is_there(place)) {
      if (!is_sound(record, directory)) damaged.add(record);
    } else if (!examined.owner) {  // those of a result that has just been committed are on their way
      missing.add(record);
    }
  }
  missing.report("file-missing", "are not there", findings);
  damaged.report("file-damaged", "are not what they were", findings);
  if (examined.owner || kind_of(directory.files()) != "a folder") return;
  Places orphans(directory.root());
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(directory.files())) {
    const bool is_folder = entry.symlink_status().type() == fs::file_type::directory;
    if (!is_folder && !known.contains(entry.path())) orphans.add(entry.path());
  }
  if (orphans.count() == 0) return;
  findings.push_back(
      {"file-orphan", Severity::note,
       fmt::format("{} files in files/ are of no result: {}", orphans.count(), orphans.text()),
       "their seeds bring them again if the database is an older one; move them away otherwise"});
}

}  // namespace

void examine_left_files(Database& database, const CampaignUnderExamination& examined, Findings& findings) {
  examine_places(database, examined, findings);
  if (examined.owner || kind_of(examined.directory.left()) != "a folder") return;
  Places waiting(examined.directory.root());
  for (const fs::path& file : whole_files(examined.directory.left())) {
    const std::string name = file.filename().string();
    const fs::path result = examined.directory.spool() / (name.substr(0, name.rfind('@')) + ".json");
    if (!is_there(result)) waiting.add(file);
  }
  if (waiting.count() == 0) return;
  findings.push_back(
      {"file-left", Severity::note,
       fmt::format("{} files are of attempts that gave no result: {}", waiting.count(), waiting.text()),
       "the next `peclet run` removes them"});
}

}  // namespace peclet::runner
