#include "runner/options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "contract/nearest_name.h"
#include "contract/provenance.h"
#include "runner/parser_tree.h"
#include "runner/verb_pages.h"
#include "runner/verb_set.h"

namespace peclet::runner {
namespace {

constexpr int exit_usage = 2;

std::string version_text() {
  const Json& origin = provenance();
  return fmt::format("peclet {} (commit {}{})", version(), origin.value("git_commit", "unknown"),
                     origin.value("git_dirty", Json()) == true ? ", with changes" : "");
}

std::string exit_code_lines() {
  std::string text = "Exit codes:\n";
  for (const auto& [code, meaning] : exit_codes()) text += fmt::format("  {:>2}  {}\n", code, meaning);
  return text + "`peclet VERB --help` says more about a verb, `peclet manual VERB | man -l -` all there is.";
}

// The command line as it was typed, and what to say where it has a fault.
class Reader {
 public:
  Reader() {
    CLI::App& app = verbs_.app();
    app.require_subcommand(1);
    app.set_version_flag("--version", std::function<std::string()>(version_text));  // reads the program file
    app.footer(exit_code_lines());
    app.formatter(std::make_shared<HelpFormatter>());
    add_running_verbs(verbs_);
    add_looking_verbs(verbs_);
    add_changing_verbs(verbs_);
    add_batch_verbs(verbs_);
    add_keeping_verbs(verbs_);
    add_other_verbs(verbs_);
  }

  CommandLine read(int argc, char** argv) {
    try {
      verbs_.app().parse(argc, argv);
    } catch (const CLI::ParseError& end) {
      if (argc > 1 && !is_verb_or_option(argv[1])) {
        fmt::print(stderr, "peclet: {}: there is no such verb; `peclet --help` lists them{}\n", argv[1],
                   suggestion(argv[1], verb_names()));
        return {std::nullopt, exit_usage};
      }
      if (const std::string unknown = unknown_option(argc, argv); !unknown.empty()) {
        fmt::print(stderr, "peclet {}\n", unknown);
        return {std::nullopt, exit_usage};
      }
      return {std::nullopt, verbs_.app().exit(end) == 0 ? 0 : exit_usage};
    }
    return {verbs_.named(), 0};
  }

  CommandTree tree() const { return describe(verbs_.app(), verbs_.examples()); }

 private:
  // Null: there is none of that name.
  const CLI::App* verb_called(const std::string& word) {
    const auto has_name = [&](const CLI::App* verb) { return verb->get_name() == word; };
    const std::vector<CLI::App*> found = verbs_.app().get_subcommands(has_name);
    return found.empty() ? nullptr : found.front();
  }

  bool is_verb_or_option(const std::string& word) {
    return word.starts_with("-") || verb_called(word) != nullptr;
  }

  std::vector<std::string> verb_names() {
    std::vector<std::string> names;
    for (const CLI::App* verb : verbs_.app().get_subcommands([](const CLI::App*) { return true; }))
      names.push_back(verb->get_name());
    return names;
  }

  // "run: --wrokers: there is no such option ...", or nothing when the fault is another one.
  std::string unknown_option(int argc, char** argv) {
    const CLI::App* const verb = argc > 1 ? verb_called(argv[1]) : nullptr;
    if (verb == nullptr) return "";
    std::vector<std::string> names;
    for (const CLI::Option* option : verb->get_options()) {
      for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    }
    for (int place = 2; place < argc; ++place) {
      const std::string word = argv[place];
      const std::string name = word.substr(0, word.find('='));
      if (!name.starts_with("--") || name == "--") continue;
      if (std::find(names.begin(), names.end(), name) != names.end()) continue;
      return fmt::format("{0}: {1}: there is no such option; `peclet {0} --help` lists them{2}",
                         verb->get_name(), name, suggestion(name, names));
    }
    return "";
  }

  VerbSet verbs_;
};

}  // namespace

CommandLine read_command_line(int argc, char** argv) { return Reader().read(argc, argv); }

CommandTree command_tree() { return Reader().tree(); }

}  // namespace peclet::runner
