#include "runner/verbs/study.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <system_error>

#include "contract/input_error.h"
#include "runner/store/own_files.h"
#include "runner/text/text_table.h"

namespace peclet::runner {
namespace {

namespace fs = std::filesystem;

constexpr const char* interpreter = "/usr/bin/python3";
constexpr const char* driver_name = "study.py";
constexpr const char* folder_of_all = "studies";  // where the command was typed

fs::path results_folder(const fs::path& chosen) {
  if (!chosen.empty()) {
    if (fs::is_directory(chosen)) return chosen;
    throw InputError("", "--results", chosen.string(), "must be a folder with studies");
  }
  if (const std::optional<fs::path> marker = own_file("results/studies")) return marker->parent_path();
  throw InputError("", "--results", "missing",
                   fmt::format("must name the folder `results` of the source or of an installation: there is "
                               "none in {}, and no build tree around this program",
                               (own_folder().parent_path() / "share" / "peclet").string()));
}

// A row without a kind is of a time when all were statements.
void count(const Json& row, StudySummary& study) {
  const std::string kind = row.value("kind", "statement");
  if (kind == "finding") return;
  const std::string answer = row.at("answer").get<std::string>();
  ++(kind == "check" ? study.checks : study.statements);
  if (answer == "holds") ++study.holding;
  if (answer == "ok") ++study.passed;
}

StudySummary read_study(const fs::path& folder) {
  StudySummary study;
  study.name = folder.filename().string();
  study.verdict = "not yet";
  const fs::path found = folder / "study.json";
  if (!fs::exists(found)) return study;
  const Json document = read_json(found);
  try {
    study.title = document.at("title").get<std::string>();
    study.verdict = document.at("verdict").get<std::string>();
    study.processor_hours = document.at("processor_hours").get<double>();
    study.date = document.at("date").get<std::string>();
    for (const Json& row : document.at("statements")) count(row, study);
  } catch (const Json::exception& error) {
    throw InputError(found.string(), "", "", fmt::format("is not what a study leaves: {}", error.what()));
  }
  return study;
}

void print(const std::string& text) {
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0) {
    throw std::system_error(errno, std::generic_category(), "standard output");
  }
}

// This process becomes the driver: signals and exit code are its own.
[[noreturn]] void become(std::vector<std::string> words) {
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  execv(interpreter, arguments.data());
  throw std::system_error(errno, std::generic_category(), interpreter);
}

[[noreturn]] void become_driver(const StudyOptions& options, const fs::path& results) {
  std::vector<std::string> words = {interpreter, (results / options.name / driver_name).string(),
                                    own_folder().string()};
  if (!options.folder.empty()) words.push_back(fs::absolute(options.folder).string());
  if (options.quick) words.emplace_back("--quick");
  if (options.with_long) words.emplace_back("--long");
  if (options.times > 1) words.insert(words.end(), {"--times", std::to_string(options.times)});
  become(std::move(words));
}

[[noreturn]] void become_driver_of_all(const StudyOptions& options, const fs::path& results,
                                       const std::vector<StudySummary>& studies) {
  if (!options.overnight) {
    double hours = 0;
    for (const StudySummary& study : studies) hours += study.processor_hours.value_or(0);
    throw InputError("", "--all", "alone",
                     fmt::format("must stand with --overnight: {:.2g} hours of processor time", hours));
  }
  const fs::path folder = options.folder.empty() ? fs::path(folder_of_all) : options.folder;
  become({interpreter, (results / "studies" / "overnight.py").string(), own_folder().string(),
          fs::absolute(folder).string()});
}

}  // namespace

std::vector<StudySummary> read_studies(const fs::path& results) {
  std::vector<StudySummary> studies;
  for (const fs::directory_entry& entry : fs::directory_iterator(results)) {
    if (fs::exists(entry.path() / driver_name)) studies.push_back(read_study(entry.path()));
  }
  std::sort(studies.begin(), studies.end(),
            [](const StudySummary& a, const StudySummary& b) { return a.name < b.name; });
  return studies;
}

std::string studies_table(const std::vector<StudySummary>& studies) {
  TextTable table;
  table.add_column("study", TextTable::Align::left);
  table.add_column("verdict", TextTable::Align::left);
  table.add_column("statements that hold");
  table.add_column("checks passed");
  table.add_column("CPU h");
  table.add_column("made");
  for (const StudySummary& study : studies) {
    const bool made = study.processor_hours.has_value();
    table.add_row({study.name, study.verdict,
                   made ? fmt::format("{} of {}", study.holding, study.statements) : "-",
                   made ? fmt::format("{} of {}", study.passed, study.checks) : "-",
                   made ? fmt::format("{:.2g}", *study.processor_hours) : "-", made ? study.date : "-"});
  }
  return table.text();
}

Json studies_json(const std::vector<StudySummary>& studies) {
  Json list = Json::array();
  for (const StudySummary& study : studies) {
    const bool made = study.processor_hours.has_value();
    list.push_back({{"study", study.name},
                    {"title", made ? Json(study.title) : Json()},
                    {"verdict", study.verdict},
                    {"statements", study.statements},
                    {"statements_that_hold", study.holding},
                    {"checks", study.checks},
                    {"checks_passed", study.passed},
                    {"processor_hours", made ? Json(*study.processor_hours) : Json()},
                    {"date", made ? Json(study.date) : Json()}});
  }
  return {{"schema_version", 1}, {"studies", list}};
}

int perform_study(const StudyOptions& options) {
  std::error_code impossible;
  if (fs::status(options.folder, impossible).type() == fs::file_type::none) {
    throw InputError("", "--folder", options.folder.string(), "cannot be made: " + impossible.message());
  }
  const fs::path results = results_folder(options.results);
  const std::vector<StudySummary> studies = read_studies(results);
  if (options.all) become_driver_of_all(options, results, studies);
  if (options.name.empty()) {
    if (!options.folder.empty()) {
      throw InputError("", "--folder", options.folder.string(), "must stand with a study, or with --all");
    }
    print(options.json ? studies_json(studies).dump(2) + '\n' : studies_table(studies));
    return 0;
  }
  const auto is_it = [&](const StudySummary& study) { return study.name == options.name; };
  if (std::none_of(studies.begin(), studies.end(), is_it)) {
    std::vector<std::string> names;
    names.reserve(studies.size());
    for (const StudySummary& study : studies) names.push_back(study.name);
    throw InputError("", "study", options.name, fmt::format("must be one of: {}", fmt::join(names, ", ")));
  }
  become_driver(options, results);
}

}  // namespace peclet::runner
