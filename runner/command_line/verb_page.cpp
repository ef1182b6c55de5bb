#include "runner/command_line/verb_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <sstream>
#include <utility>

#include "contract/exit_codes.h"

namespace peclet::runner {
namespace {

constexpr std::size_t help_width = 100;

// Lines of no more than `help_width` characters.
std::string wrapped(const std::string& text) {
  std::istringstream words(text);
  std::string lines;
  std::size_t used = 0;
  for (std::string word; words >> word;) {
    const bool breaks = used > 0 && used + 1 + word.size() > help_width;
    if (used > 0) lines += breaks ? '\n' : ' ';
    used = (used == 0 || breaks ? 0 : used + 1) + word.size();
    lines += word;
  }
  return lines + '\n';
}

}  // namespace

VerbPage page(const std::string& prose, std::vector<VerbExample> examples, std::vector<int> exit_codes) {
  VerbPage made{{}, std::move(examples), std::move(exit_codes)};
  std::istringstream lines(prose);
  std::string paragraph;
  for (std::string line; std::getline(lines, line);) {
    if (line.empty() && !paragraph.empty()) made.paragraphs.push_back(std::exchange(paragraph, ""));
    if (!line.empty()) paragraph += (paragraph.empty() ? "" : " ") + line;
  }
  if (!paragraph.empty()) made.paragraphs.push_back(paragraph);
  return made;
}

std::string exit_code_lines(const std::vector<int>& codes) {
  static const std::map<int, std::string> meanings{
      {ExitCode::done, "done; of a run: every point converged, or has all its seeds"},
      {ExitCode::error, "error"},
      {ExitCode::usage, "usage, or faulty input; nothing has been written"},
      {ExitCode::unconverged, "finished, but some points are capped, failed, cancelled or lost seeds"},
      {ExitCode::unfinished,
       "not finished yet; of set, cancel and retry: asked for, and not carried out yet"},
      {ExitCode::owned, "another process owns the campaign"},
      {ExitCode::integrity, "integrity: the database is damaged, or a seed gave two different results"},
      {ExitCode::stopped,
       "stopped by a signal or a time limit, or at the end of its budget; the same command goes on"}};
  std::string text = "Exit codes:\n";
  for (const auto& [code, meaning] : meanings) {
    if (codes.empty() || std::count(codes.begin(), codes.end(), code) > 0)
      text += fmt::format("  {:>2}  {}\n", code, meaning);
  }
  return text;
}

std::string help_footer(const VerbPage& page, const std::string& example) {
  std::string text;
  for (const std::string& paragraph : page.paragraphs) text += wrapped(paragraph) + '\n';
  text += exit_code_lines(page.exit_codes) + '\n';
  text += page.examples.empty() ? "Example:\n" : "Examples:\n";
  text += "  " + example + '\n';
  for (const VerbExample& more : page.examples) {
    text += (more.purpose.empty() ? "" : "  # " + more.purpose + '\n') + "  " + more.command + '\n';
  }
  text.pop_back();
  return text;
}

}  // namespace peclet::runner
