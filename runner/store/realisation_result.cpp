#include "runner/store/realisation_result.h"

#include <cstddef>
#include <string_view>
#include <utility>

#include "contract/input_error.h"
#include "contract/sha256.h"

namespace peclet::runner {
namespace {

// Time is no part of the physics; the machine, and where it keeps the state of a blow-up, is none either. Nor
// are the files beside the result: a log among them has times in it.
std::string content_hash(Json& document) {
  // A result may be large, so these parts are laid aside, not the others copied.
  const auto take = [](Json& object, const char* key) {
    Json part = std::move(object[key]);
    object.erase(key);
    return part;
  };
  Json& ending = document["ending"];
  const bool has_state = ending.contains("state"), has_files = document.contains("files");
  Json cost = take(document, "cost"), engine = take(document, "engine"), state = take(ending, "state");
  Json files = take(document, "files");
  const std::string hash = sha256(canonical_json(document));
  document["cost"] = std::move(cost);
  document["engine"] = std::move(engine);
  if (has_files) document["files"] = std::move(files);
  if (has_state) ending["state"] = std::move(state);
  return hash;
}

// Requires JSON. What is left takes an eighth less room when it is deflated.
std::string without_white_space(std::string_view json) {
  std::string text;
  text.reserve(json.size());
  bool is_quoted = false;
  for (std::size_t i = 0; i < json.size(); ++i) {
    const char c = json[i];
    if (c == '"') is_quoted = !is_quoted;
    if (!is_quoted && (c == ' ' || c == '\n' || c == '\r' || c == '\t')) continue;
    text += c;
    if (is_quoted && c == '\\') text += json[++i];
  }
  return text;
}

}  // namespace

RealisationResult parse_result(std::string text) {
  if (const std::string excess = excess_of(text); !excess.empty()) throw ResultError(excess);
  RealisationResult result;
  result.text = std::move(text);
  try {
    result.document = parse_json(result.text, "result");
  } catch (const InputError& error) {
    throw ResultError(error.what());
  }
  result.text = without_white_space(result.text);
  result.engine = check_shape(result.document);
  result.point = result.document["point"].get<std::string>();
  result.seed = result.document["seed"].get<int>();
  result.cause = result.document["ending"]["cause"].get<std::string>();
  try {
    result.content_sha256 = content_hash(result.document);
  } catch (const std::invalid_argument& error) {
    throw ResultError(error.what());
  }
  return result;
}

std::set<std::string> flags_of(const RealisationResult& result) {
  std::set<std::string> codes;
  if (!result.completed()) return codes;
  for (const Json& warning : result.document.value("warnings", Json::array())) {
    const std::string& code = warning.at("code").get_ref<const std::string&>();
    if (!code.starts_with("inertia-")) codes.insert(code);
  }
  return codes;
}

}  // namespace peclet::runner
