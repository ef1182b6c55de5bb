#include "runner/verb_set.h"

#include "runner/verb_pages.h"

namespace peclet::runner {

CLI::App* VerbSet::add(const char* name, const char* description, const char* example) {
  CLI::App* const verb = app_.add_subcommand(name, description);
  verb->footer(help_footer(name, example));
  examples_[name] = example;
  return verb;
}

void add_file(CLI::App* verb, std::filesystem::path& path) {
  verb->add_option("campaign", path, "Campaign file (JSON)")
      ->required()
      ->type_name(value_name::campaign_file);
}

void add_file_or_folder(CLI::App* verb, std::filesystem::path& path) {
  verb->add_option("campaign", path, "Campaign file, or its .peclet folder")
      ->required()
      ->type_name(value_name::campaign);
}

void add_directory(CLI::App* verb, std::filesystem::path& path) {
  verb->add_option("--directory", path,
                   "Folder of the campaign's database and checkpoints; NAME.peclet beside "
                   "NAME.json unless given")
      ->type_name(value_name::folder);
}

void add_accept_engine(CLI::App* verb, std::string& name) {
  verb->add_option("--accept-engine", name,
                   "Version, or 6 or more digits of the hash, of the engine that is there now: results of "
                   "another one at open points are kept apart");
}

void add_seconds(CLI::App* verb, const char* name, double& seconds, const char* meaning) {
  verb->add_option(name, seconds, meaning)
      ->type_name("SECONDS")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
}

}  // namespace peclet::runner
