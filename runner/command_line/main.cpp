// peclet: campaigns of realisations, from scenes to converged averages.
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cerrno>
#include <exception>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "contract/errors.h"
#include "contract/own_folder.h"
#include "contract/provenance.h"
#include "contract/usage_fault.h"
#include "runner/command_line/print.h"
#include "runner/command_line/verb_set.h"
#include "runner/store/campaign_directory.h"

namespace peclet::runner {
namespace {

std::string version_text() {
  const Json& origin = provenance();
  return fmt::format("peclet {} (commit {}{})", version(), origin.value("git_commit", "unknown"),
                     origin.value("git_dirty", Json()) == true ? ", with changes" : "");
}

// Verbs of the engine for files of users: `peclet sizes` is `peclet-engine sizes`.
constexpr std::array<std::string_view, 4> engine_verbs = {"sizes", "start", "snapshot", "trajectory"};

[[noreturn]] void become_engine(std::vector<std::string> words) {
  const std::string engine = (own_folder() / "peclet-engine").string();
  words.insert(words.begin(), engine);
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  ::execv(engine.c_str(), arguments.data());
  throw std::system_error(errno, std::generic_category(), engine + ", which belongs beside peclet");
}

struct CompletionOptions {
  std::string shell;             // bash
  std::filesystem::path output;  // "": standard output
  bool quiet = false;            // no message about where the script was written
};

void add_completion(VerbSet& verbs) {
  const auto write = [&verbs](const CompletionOptions& options) {
    deliver(bash_completion(verbs.app()), options.output, options.quiet);
  };
  const auto [verb, options] = verbs.add<CompletionOptions>(
      write, "completion", "Print a script with which bash completes verbs, options and files", {0, 1, 2},
      R"page(
Put the line of the example into ~/.bashrc. `cmake --install` puts the script where bash finds it by itself.

  eval "$(peclet completion bash)"
)page");
  add_option(verb, "shell SHELL", options->shell, "The shell")->required()->check(CLI::IsMember({"bash"}));
  add_output(verb, options->output);
  add_quiet(verb, options->quiet);
}

// Returns a line that says where the pages of this program are; "" if they are not there.
std::string place_of_pages() {
  const std::optional<std::filesystem::path> pages = own_file("docs/README.md");
  return pages ? fmt::format("\nPages: {}", pages->string()) : "";
}

void add_all(VerbSet& verbs) {
  CLI::App& app = verbs.app();
  app.require_subcommand(1);
  // A function, called on demand, because it reads the program file.
  app.set_version_flag("--version", std::function<std::string()>(version_text));
  app.footer(
      exit_code_lines({}) +
      "`peclet help VERB` says more about a verb.\n"
      "`peclet sizes`, `start`, `snapshot` and `trajectory` are those of peclet-engine; each has --help." +
      place_of_pages());
  app.formatter(std::make_shared<HelpFormatter>());
  add_running_verbs(verbs);
  add_viewing_verbs(verbs);
  add_curve_verbs(verbs);
  add_changing_verbs(verbs);
  add_completion(verbs);
}

std::vector<std::string> words_of(int argc, char** argv) {
  std::vector<std::string> words(argv + std::min(argc, 1), argv + argc);
  if (words == std::vector<std::string>{"version"}) words.front() = "--version";
  if (!words.empty() && words.front() == "help") {  // `peclet help run` is `peclet run --help`
    words.erase(words.begin());
    words.insert(words.begin() + std::min<std::ptrdiff_t>(1, std::ssize(words)), "--help");
  }
  return words;
}

int complain(const std::string& fault) {
  say(fmt::format("peclet: {}\n", fault));
  return ExitCode::usage;
}

// Runs the verb that is named and returns its exit code; 0 after help or version, 2 after a fault of usage.
int obey(const std::vector<std::string>& words) {
  if (!words.empty() && std::ranges::find(engine_verbs, words.front()) != engine_verbs.end())
    become_engine(words);
  VerbSet verbs;
  add_all(verbs);
  CLI::App& app = verbs.app();
  try {
    app.parse(std::vector<std::string>(words.rbegin(), words.rend()));  // the parser takes them in reverse
  } catch (const CLI::ParseError& end) {
    const bool is_known =
        words.empty() || words.front().starts_with("-") || verb_called(app, words) != nullptr;
    if (end.get_exit_code() == 0 && is_known) return app.exit(end);  // help or version
    return complain(usage_fault(app, words, end));
  } catch (const InputError& fault) {
    return complain(fmt::format("{}: {}", words.front(), fault.what()));
  }
  return verbs.action()();
}

}  // namespace
}  // namespace peclet::runner

int main(int argc, char** argv) {
  using namespace peclet::runner;
  try {
    return obey(words_of(argc, argv));
  } catch (const std::exception& error) {
    say(fmt::format("peclet: {}\n", message_of(error)));
    return exit_code_of(error);
  }
}
