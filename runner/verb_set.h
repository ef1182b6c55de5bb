// What the functions that add verbs to the command line share.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "runner/options.h"

namespace peclet::runner {

// The parser, and the verb that was named once it has parsed.
class VerbSet {
 public:
  VerbSet() = default;
  VerbSet(const VerbSet&) = delete;
  VerbSet& operator=(const VerbSet&) = delete;

  CLI::App& app() { return app_; }
  const CLI::App& app() const { return app_; }
  const std::map<std::string, std::string>& examples() const { return examples_; }  // by verb
  const std::optional<Verb>& named() const { return named_; }

  CLI::App* add(const char* name, const char* description, const char* example);

  // `options`, into which the parser writes, become the command when the verb is the one that was named.
  template <typename Options>
  void choose(CLI::App* verb, const std::shared_ptr<Options>& options) {
    verb->callback([this, options] { named_ = *options; });
  }

 private:
  CLI::App app_{"Campaigns of dense-suspension simulations: from a scene to converged averages", "peclet"};
  std::optional<Verb> named_;
  std::map<std::string, std::string> examples_;
};

// One function a verb, in the file of its group. In the order in which help lists them.
void add_running_verbs(VerbSet& verbs);
void add_looking_verbs(VerbSet& verbs);
void add_changing_verbs(VerbSet& verbs);
void add_batch_verbs(VerbSet& verbs);
void add_keeping_verbs(VerbSet& verbs);
void add_other_verbs(VerbSet& verbs);

// Options that several verbs have.
void add_file(CLI::App* verb, std::filesystem::path& path);
void add_file_or_folder(CLI::App* verb, std::filesystem::path& path);
void add_directory(CLI::App* verb, std::filesystem::path& path);
void add_accept_engine(CLI::App* verb, std::string& name);
// A time > 0, which has a default.
void add_seconds(CLI::App* verb, const char* name, double& seconds, const char* meaning);

}  // namespace peclet::runner
