#include "runner/page/page_html.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <string_view>

#include "contract/sha256.h"
#include "runner/campaign/quoting.h"
#include "runner/page/page_data.h"

namespace peclet::runner {
namespace {

// Returns 'sha256-...', by which a Content-Security-Policy names an inline style or script.
std::string policy_hash(std::string_view content) { return "'sha256-" + sha256_base64(content) + '\''; }

// Returns JSON that is safe in a script element: it can neither end the element nor begin another one.
std::string inert(const Json& data) {
  std::string safe;
  for (const char c : data.dump()) {
    safe += c == '<' || c == '>' || c == '&' ? fmt::format("\\u{:04x}", c) : std::string(1, c);
  }
  return safe;
}

const std::string& whole_script() {
  static const std::string script =
      fmt::format("{}const drawingScript = {};\n{}", page_scripts.front(), inert(drawing_script),
                  fmt::join(page_scripts.begin() + 1, page_scripts.end(), ""));
  return script;
}

// Returns the template with texts in the place of each @MARK@. The texts are not searched for further marks.
std::string filled(std::string_view text, const std::map<std::string_view, std::string>& marks) {
  std::string page;
  for (bool is_mark = false; !text.empty(); is_mark = !is_mark) {
    const std::string_view part = text.substr(0, text.find('@'));
    page += is_mark ? marks.at(part) : part;
    text.remove_prefix(std::min(part.size() + 1, text.size()));
  }
  return page;
}

}  // namespace

std::string page_policy(bool live) {
  return fmt::format("default-src 'none'; style-src {}; script-src {}; base-uri 'none'; form-action 'none'{}",
                     policy_hash(page_style), policy_hash(whole_script()),
                     live ? "; connect-src 'self'" : "");
}

std::string page_program() {
  return sha256(fmt::format("{}{}{}", page_template, page_style, whole_script()));
}

std::string page_html(const Json& data) {
  return filled(page_template, {{"NAME", escaped(data.at("campaign").get<std::string>())},
                                {"POLICY", page_policy(data.contains("live"))},
                                {"STYLE", page_style},
                                {"SCRIPT", whole_script()},
                                {"DATA", inert(data)}});
}

std::string report_html(Database& database, std::optional<std::int64_t> owner) {
  return page_html(page_data(database, owner));
}

}  // namespace peclet::runner
