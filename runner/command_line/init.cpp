#include "runner/command_line/init.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <vector>

#include "contract/durable_file.h"
#include "contract/errors.h"
#include "contract/guarded_file.h"
#include "contract/named_files.h"
#include "contract/text.h"
#include "runner/campaign/campaign.h"
#include "runner/campaign/campaign_file.h"
#include "runner/campaign/text_table.h"

namespace peclet::runner {
namespace {

constexpr std::string_view folder_of_examples = "examples-";

std::vector<std::string> example_names() {
  std::vector<std::string> names;
  for (const auto& [name, text] : example_texts()) {
    if (name.starts_with(folder_of_examples)) names.push_back(name.substr(folder_of_examples.size()));
  }
  return names;
}

const std::string& example_text(const std::string& name) {
  const auto found = example_texts().find(std::string(folder_of_examples) + name);
  if (found != example_texts().end()) return found->second;
  const std::vector<std::string> names = example_names();
  const std::string nearest = nearest_name(name, names);
  throw InputError("", "--example", name,
                   fmt::format("must be one of {}{}", fmt::join(names, ", "),
                               nearest.empty() ? "" : fmt::format("; did you mean {}?", nearest)));
}

struct CompanionFile {
  std::filesystem::path path;
  std::string text;
};

// Returns the files beside the campaign that its engine's words name, as far as they are compiled in.
std::vector<CompanionFile> companions_of(const std::string& text, const std::filesystem::path& campaign) {
  std::vector<CompanionFile> companions;
  for (const Json& word : parse_json_input(text, "").value("engine", Json::array())) {
    const std::filesystem::path name = word.get<std::string>();
    for (const auto& [known, content] : example_texts()) {
      const bool is_it =
          known.ends_with("-" + name.stem().string()) && !known.starts_with(folder_of_examples);
      if (is_it) companions.push_back({(campaign.parent_path() / name).lexically_normal(), content});
    }
  }
  return companions;
}

// Throws InputError if something is there, also a dangling link.
void require_absent(const std::filesystem::path& file) {
  if (!kind_of(file).empty())
    throw InputError(file.string(), "", "", "is there already, and is not replaced");
}

// Returns the first line of an example without the marks of a comment.
std::string subject_of(const std::string& text) { return text.substr(3, text.find('\n') - 3); }

std::string list_of_examples() {
  TextTable table;
  table.add_column("example", TextTable::Align::left);
  table.add_column("what it is", TextTable::Align::left);
  for (const std::string& name : example_names()) table.add_row({name, subject_of(example_text(name))});
  return table.text() +
         "\npeclet init FILE.json --example NAME writes one; its first lines say what to change\n";
}

}  // namespace

std::string init_campaign(const InitOptions& options) {
  if (options.list) return list_of_examples();
  const std::filesystem::path& file = options.campaign;
  if (file.empty())
    throw InputError("", "campaign", "missing", "must be the name of a new file, or use --list");
  if (file.extension() != ".json") {
    throw InputError(file.string(), "", file.extension().string(), "must end in .json");
  }
  const std::string name = file.stem().string();
  check_campaign_name(name, file.string());
  require_absent(file);
  const std::string& text = example_text(options.example);
  std::vector<CompanionFile> companions = companions_of(text, file);
  // A file may be there already for another campaign.
  std::erase_if(companions, [](const CompanionFile& one) {
    return !kind_of(one.path).empty() && read_input(one.path) == one.text;
  });
  for (const CompanionFile& companion : companions) require_absent(companion.path);
  check_output(file);
  for (const CompanionFile& companion : companions) {
    write_durably(companion.path, companion.text);
    if (!companion.text.starts_with("#!")) continue;
    using enum std::filesystem::perms;  // a program
    permissions(companion.path, owner_exec | group_exec | others_exec, std::filesystem::perm_options::add);
  }
  write_durably(file, with_value(text, {"name"}, name));
  return fmt::format(
      "{0} is written: {2}\n"
      "  peclet validate {1}\n"
      "  peclet run {1}\n",
      file.string(), words_for(file, ""), subject_of(text));
}

}  // namespace peclet::runner
