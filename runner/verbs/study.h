// The verb `peclet study`: the studies of published statements, and what they found.
//
// A study is a folder with study.py, which remakes it, and study.json, what it found when it was last made
// whole: title, verdict ("holds", "holds with a difference", "does not hold", "not yet", "findings only";
// checks that failed are counted behind it), processor_hours, date, and statements, each of a kind:
// "statement", of a publication ("holds", "does not hold" or "open"), "check" of our methods ("ok", "failed"
// or "open"), or "finding". results/studies writes that file and has the rule by which the verdict follows.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "contract/json.h"

namespace peclet::runner {

struct StudyOptions {
  std::string name;   // "": list them
  bool list = false;  // said, which changes nothing
  bool all = false;   // every study in turn, whole, which must be said:
  bool overnight = false;
  bool quick = false;
  bool with_long = false;         // also the points that take hours
  int times = 1;                  // as many seeds
  bool json = false;              // the list, for programs
  std::filesystem::path results;  // folder of the studies; the program's own unless given
  std::filesystem::path folder;   // of the campaigns; a temporary one unless given, of all "studies"
};

struct StudySummary {
  std::string name;
  std::string title;                // "" before the study was made
  std::string verdict;              // "not yet" before the study was made
  int holding = 0, statements = 0;  // of publications
  int passed = 0, checks = 0;
  std::optional<double> processor_hours;
  std::string date;
};

// The folders of `results` with a study.py, in alphabetical order. Throws InputError for a study.json that is
// none.
std::vector<StudySummary> read_studies(const std::filesystem::path& results);

std::string studies_table(const std::vector<StudySummary>& studies);
Json studies_json(const std::vector<StudySummary>& studies);

// Lists the studies, or runs one or all with the programs in the folder of this one; returns the exit code.
// Throws InputError for a study that is not there, std::system_error.
int perform_study(const StudyOptions& options);

}  // namespace peclet::runner
