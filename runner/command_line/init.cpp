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
  names.reserve(example_texts().size());
  for (const auto& [name, text] : example_texts()) names.push_back(name.substr(folder_of_examples.size()));
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
  if (!kind_of(file).empty()) {  // also a dangling link
    throw InputError(file.string(), "", "", "is there already, and is not replaced");
  }
  const std::string& text = example_text(options.example);
  check_output(file);
  write_durably(file, with_value(text, {"name"}, name));
  return fmt::format(
      "{0} is written: {2}\n"
      "  peclet validate {1}\n"
      "  peclet run {1}\n",
      file.string(), words_for(file, ""), subject_of(text));
}

}  // namespace peclet::runner
