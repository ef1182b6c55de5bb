#include "runner/batch/batch_system.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <sstream>
#include <system_error>

#include "contract/durable_file.h"
#include "contract/errors.h"
#include "contract/text.h"
#include "runner/campaign/quoting.h"
#include "runner/engines/engine_process.h"

namespace peclet::runner {
namespace {

// A restarted controller answers after some tens of seconds.
constexpr std::chrono::seconds patience{60};
// Exit code of submit.sh if the connection failed on the way (EX_TEMPFAIL).
constexpr int exit_nobody_knows = 75;
constexpr const char* letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZ_";

std::string one_line(std::string text) {
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text.find('\n') == std::string::npos ? text : "";
}

std::optional<TaskState> task_state(const std::string& word) {
  if (word == "waiting") return TaskState::waiting;
  if (word == "running") return TaskState::running;
  if (word == "ended") return TaskState::ended;
  return std::nullopt;
}

// Adds a task. If it is listed twice because it was submitted twice, the livelier state counts.
void add(QueryAnswer& answer, const std::string& job, int task, TaskState state) {
  if (std::find(answer.jobs.begin(), answer.jobs.end(), job) == answer.jobs.end()) answer.jobs.push_back(job);
  const auto [known, is_new] = answer.tasks.emplace(task, state);
  if (!is_new && known->second == TaskState::ended) known->second = state;
}

// True if the shell is between quotes after this beginning of a line.
bool is_between_quotes(const std::string& before) {
  char open = 0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    const char c = before[i];
    if (c == '\\' && open != '\'') {
      ++i;
    } else if (open == 0 && (c == '"' || c == '\'')) {
      open = c;
    } else if (c == open) {
      open = 0;
    }
  }
  return open != 0;
}

std::string quoted_for(const std::string& before, const std::string& name, const std::string& value,
                       const std::string& file) {
  const auto refuse = [&](const std::string& why) {
    throw InputError("", "", value,
                     fmt::format("cannot be put in the place of @{}@ in {}: {}", name, file, why));
  };
  if (has_control_characters(value)) refuse("it has a line break or another control character");
  if (is_plain(value)) return value;
  if (before.starts_with("#SBATCH")) {
    if (value.find('\\') != std::string::npos) refuse("Slurm does not replace %a after a backslash");
    return sbatch_word(value);
  }
  if (before.starts_with("#")) {
    refuse(
        "how other lines than #SBATCH that begin with # are quoted is not known; letters, digits and "
        "_@+=:,./- are safe");
  }
  if (is_between_quotes(before)) refuse("it stands between quotes; without them peclet puts its own");
  return shell_word(value);
}

}  // namespace

BatchTemplate batch_template(const std::string& system, const fs::path& folder) {
  BatchTemplate scripts;
  for (const std::string name : {"job", "submit", "query", "cancel", "largest"}) {
    const std::string file = name + ".sh";
    const auto built_in = built_in_templates().find(system + '-' + name);
    if (!folder.empty() && fs::is_regular_file(folder / file)) {
      scripts[file] = read_file(folder / file);
    } else if (built_in != built_in_templates().end()) {
      scripts[file] = built_in->second;
    } else if (folder.empty()) {
      throw InputError(
          "", "", system,
          "is not a batch system that peclet knows; slurm, pbs and lsf are, and --template FOLDER "
          "describes another");
    } else {
      throw InputError((folder / file).string(), "", "", "is missing from the template");
    }
  }
  return scripts;
}

std::string template_text(const std::string& name) {
  std::string names;
  for (const auto& [known, text] : built_in_templates()) {
    if (known == name) return text;
    names += known + '\n';
  }
  if (name.empty()) return names;
  throw InputError("", "", name, "is not a template; `peclet template` lists them");
}

std::string fill_in(const std::string& text, const std::map<std::string, std::string>& values,
                    const std::string& file) {
  std::string filled;
  std::size_t from = 0;
  for (;;) {
    const std::size_t begin = text.find('@', from);
    const std::size_t end = begin == std::string::npos ? begin : text.find_first_not_of(letters, begin + 1);
    if (begin == std::string::npos || end == std::string::npos) return filled + text.substr(from);
    filled += text.substr(from, begin - from);
    const std::string name = text.substr(begin + 1, end - begin - 1);
    if (text[end] != '@' || name.empty()) {  // not a placeholder: B:USR1@120
      filled += text.substr(begin, end - begin);
      from = end;
      continue;
    }
    const auto value = values.find(name);
    if (value == values.end()) throw InputError(file, "", '@' + name + '@', "is not a placeholder");
    const std::size_t line_begin = text.rfind('\n', begin) + 1;  // npos + 1 is 0
    filled += quoted_for(text.substr(line_begin, begin - line_begin), name, value->second, file);
    from = end + 1;
  }
}

bool QueryAnswer::alive(int task) const {
  const auto known = tasks.find(task);
  return known != tasks.end() && known->second != TaskState::ended;
}

Submission submit_job(const fs::path& folder, const std::string& name,
                      const std::vector<std::string>& options) {
  std::vector<std::string> words{"sh", (folder / "submit.sh").string(), name, (folder / "job.sh").string()};
  words.insert(words.end(), options.begin(), options.end());
  CommandAnswer answer;
  try {
    answer = run_command(words, patience);
  } catch (const std::system_error& error) {  // not even the shell could be started
    return JobRefused{error.what()};
  }
  if (answer.succeeded()) {
    const std::string job = one_line(answer.output);
    if (!job.empty()) return JobTaken{job};
    return JobUnknown{"it does not say the job's number: " + answer.output};
  }
  if (answer.timed_out || !answer.ending.status || *answer.ending.status == exit_nobody_knows) {
    return JobUnknown{answer.complaint()};
  }
  std::string why;
  const std::optional<QueryAnswer> known = query_job(folder, name, why);
  if (known && !known->jobs.empty()) return JobTaken{fmt::format("{}", fmt::join(known->jobs, ", "))};
  return JobRefused{answer.complaint()};
}

std::optional<QueryAnswer> query_job(const fs::path& folder, const std::string& name, std::string& why) {
  const CommandAnswer said = run_command({"sh", (folder / "query.sh").string(), name}, patience);
  if (!said.succeeded()) {
    why = said.complaint();
    return std::nullopt;
  }
  QueryAnswer answer;
  std::istringstream lines(said.output);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string job, index, state, rest;
    words >> job >> index >> state >> rest;
    const std::optional<int> task = number_in<int>(index);
    const std::optional<TaskState> known = task_state(state);
    if (!task || !known || !rest.empty()) {
      why = "the answer has another form: " + line;
      return std::nullopt;
    }
    add(answer, job, *task, *known);
  }
  return answer;
}

bool cancel_job(const fs::path& folder, const std::string& name, std::string& why) {
  const CommandAnswer said = run_command({"sh", (folder / "cancel.sh").string(), name}, patience);
  if (!said.succeeded()) why = said.complaint();
  return said.succeeded();
}

int largest_array(const BatchTemplate& scripts, int otherwise) {
  const CommandAnswer said = run_command({"sh", "-c", scripts.at("largest.sh")}, patience);
  const std::optional<int> number = said.succeeded() ? number_in<int>(one_line(said.output)) : std::nullopt;
  return number && *number > 0 ? *number : otherwise;
}

}  // namespace peclet::runner
