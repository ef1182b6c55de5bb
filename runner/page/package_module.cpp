#include "runner/page/package_module.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <vector>

#include "contract/errors.h"
#include "contract/own_folder.h"
#include "runner/engines/engine_process.h"
#include "runner/store/campaign_directory.h"

namespace peclet::runner {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> command_of(const std::string& module) {
  const fs::path package = own_folder().parent_path() / "lib/python3/dist-packages/peclet";
  if (fs::exists(package / "answer.py")) return {own_python(), (package / "answer.py").string(), module};
  if (const std::optional<fs::path> source = own_file("python/peclet/answer.py"))
    return {own_python(), source->string(), module};
  return {own_python(), "-m", "peclet.answer", module};
}

}  // namespace

Json answer_of_package(const std::string& verb, const std::string& module, const std::string& modules,
                       const Json& document, const std::string& file) {
  constexpr std::chrono::minutes patience(60);
  const std::vector<std::string> command = command_of(module);
  // Keeps Python from importing a file of the present folder in place of a module.
  std::vector<std::string> words{"env", "PYTHONSAFEPATH=1"};
  words.insert(words.end(), command.begin(), command.end());
  const CommandAnswer said = run_command(words, patience, document.dump());
  if (!said.succeeded()) {
    throw std::runtime_error(fmt::format("{}: the fits need python3 with {}; `{}` has not run: {}", verb,
                                         modules, fmt::join(command, " "), said.complaint()));
  }
  Json answer = Json::parse(said.output);
  if (answer.contains("refused")) {
    const auto [place, value, rule] = answer["refused"].get<std::array<std::string, 3>>();
    throw InputError(file, place, value, rule);
  }
  return answer;
}

Json json_or_null(const std::optional<double>& number) { return number ? Json(*number) : Json(nullptr); }

}  // namespace peclet::runner
