#include "runner/store/realisation_result.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "contract/documents.h"
#include "contract/errors.h"
#include "contract/sha256.h"
#include "runner/campaign/quoting.h"
#include "runner/statistics/quantities.h"
#include "runner/store/result_files.h"

namespace peclet::runner {

std::string excess_of(std::string_view text) {
  if (text.size() > largest_result) {
    return fmt::format("it has {} bytes, more than {}", text.size(), largest_result);
  }
  std::size_t values = 1, structures = 0;
  int depth = 0;
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted && c == '\\') ++i;
    if (c == '"') quoted = !quoted;
    if (quoted) continue;
    if (c == ',') ++values;
    if (c == '[' || c == '{' || c == ':') ++structures;
    if (c == '[' || c == '{') ++depth;
    if (c == ']' || c == '}') --depth;
    if (depth > deepest_result) return fmt::format("it is nested more than {} deep", deepest_result);
  }
  if (structures > most_structures) {
    return fmt::format("it has more than {} lists, objects and keys", most_structures);
  }
  return values > most_values ? fmt::format("it has more than {} values", most_values) : "";
}

namespace {

[[noreturn]] void refuse(const std::string& pointer, std::string_view allowed) {
  throw ResultError(fmt::format("{}: {}", plain(pointer, longest_name), allowed));
}

void must_have_name(const std::string& name, const std::string& pointer) {
  if (is_name(name)) return;
  refuse(pointer, fmt::format("must have a name of 1 to {} bytes without control characters", longest_name));
}

// Checks a mean, whose structure is the engine's choice: the runner takes numbers from it by their paths, and
// shows these paths.
void check_mean(const Json& mean, const std::string& pointer) {
  for (const auto& [name, value] : mean.items()) {
    if (value.is_number()) continue;
    const std::string below = pointer + '/' + name;
    if (!value.is_null() && !value.is_structured())
      refuse(below, "must be a number, null, a list or an object");
    if (value.is_structured()) check_mean(value, below);
  }
  if (!mean.is_object()) return;
  for (const auto& [name, value] : mean.items()) must_have_name(name, pointer + '/' + name);
}

// True if the value is lists within lists of numbers and nulls, as long as the axes from `axis` on.
bool has_shape(const Json& value, const std::vector<QuantityAxis>& axes, std::size_t axis = 0) {
  if (axis == axes.size()) return value.is_number() || value.is_null();
  return value.is_array() && value.size() == axes[axis].values.size() &&
         std::all_of(value.begin(), value.end(),
                     [&](const Json& element) { return has_shape(element, axes, axis + 1); });
}

// Limits the numbers that the axes describe, because estimates take room for all of them.
void check_sizes(const std::vector<Quantity>& all) {
  std::size_t together = 0;
  for (const Quantity& quantity : all) {
    std::size_t elements = 1;
    for (const QuantityAxis& axis : quantity.axes)
      elements = std::min(elements * axis.values.size(), most_values + 1);
    together += elements;
    if (together <= most_values) continue;
    refuse(fmt::format("/quantities/{}/axes", quantity.name),
           fmt::format("must not make more than {} numbers, together with the quantities before it",
                       most_values));
  }
}

// Checks that no two numbers have the same path, by which a campaign names its target.
void check_paths(const std::vector<Quantity>& all) {
  std::set<std::string_view> paths;
  for (const Quantity& quantity : all) {
    if (!paths.insert(quantity.name).second)
      refuse("/mean/" + quantity.name, "must not be there in two ways");
  }
}

// Checks that the quantity's values in the mean have the shape of its description.
void check_values(const Quantity& quantity, const std::vector<Quantity>& all, const Json& mean) {
  const auto must_be_there = [&](const std::string& path, bool or_scalar) {
    const Json* const value = at_path(mean, path);
    if (value == nullptr) refuse("/mean/" + path, "is missing, though it is among the quantities");
    if (value->is_null() || (or_scalar && value->is_number()) || has_shape(*value, quantity.axes)) return;
    refuse("/mean/" + path, "must be a number, or lists of them, as the axes of its quantity say");
  };
  if (!quantity.ratio) {
    must_be_there(quantity.name, false);
  } else {
    must_be_there(quantity.name + '/' + quantity.ratio->numerator, true);
    must_be_there(quantity.name + '/' + quantity.ratio->denominator, true);
  }
  if (!quantity.control) return;
  const std::string& wanted = quantity.control->quantity;
  const auto control =
      std::lower_bound(all.begin(), all.end(), wanted,
                       [](const Quantity& other, const std::string& name) { return other.name < name; });
  const bool is_another = control != all.end() && control->name == wanted && wanted != quantity.name;
  const auto sizes = [](const Quantity& of) {
    std::vector<std::size_t> lengths;
    for (const QuantityAxis& axis : of.axes) lengths.push_back(axis.values.size());
    return lengths;
  };
  if (!is_another || control->ratio || sizes(*control) != sizes(quantity)) {
    refuse(fmt::format("/quantities/{}/control/quantity", quantity.name),
           "must be another quantity of the same shape, both of the estimator mean");
  }
}

void check_quantities(const Json& document) {
  const auto quantities = document.find("quantities");
  if (quantities == document.end() || quantities->empty()) return;  // the engine describes nothing
  if (!document["mean"].is_object()) refuse("/quantities", "must be null after this ending");
  for (const auto& [name, about] : quantities->items()) must_have_name(name, "/quantities/" + name);
  const std::vector<Quantity> all = quantities_of(document);
  check_sizes(all);
  for (const Quantity& quantity : all) check_values(quantity, all, document["mean"]);
}

void check_ending(const Json& document) {
  const bool completed = has_results(document["ending"]["cause"].get<std::string>());
  for (const char* const part : {"mean", "blocks"}) {
    if (document[part].is_object() == completed) continue;
    refuse(std::string("/") + part, completed ? "must be an object" : "must be null after this ending");
  }
  if (!completed) return;
  // A realisation that could not be packed has no final state.
  if (document["final_state_sha256"].is_null())
    refuse("/final_state_sha256", "must be a SHA-256 after this ending");
  check_mean(document["mean"], "/mean");
  const auto descriptions = document.find("quantities");
  if (descriptions == document.end() || descriptions->empty()) check_paths(quantities_of(document));
}

// Returns the pointer of a number that is too large; the JSON reader has refused infinite ones. The pointer
// is put together on the way back, because usually none of thousands of numbers is too large.
std::optional<std::string> too_large(const Json& value) {
  if (value.is_number_float() && !(std::abs(value.get<double>()) <= largest_number)) return "";
  if (!value.is_structured()) return std::nullopt;
  for (auto member = value.begin(); member != value.end(); ++member) {
    if (member->is_primitive() && !member->is_number_float()) continue;
    if (const std::optional<std::string> below = too_large(*member)) {
      const std::string key = value.is_object() ? member.key() : fmt::format("{}", member - value.begin());
      return '/' + key + *below;
    }
  }
  return std::nullopt;
}

// Returns the hash of what repetitions must share. Times and machine are left out, and so are the place of a
// blow-up's state and the files beside the result, whose logs have times in them.
std::string content_hash(Json& document) {
  // These parts are set aside instead of copying the others, because a result may be large.
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

// Removes white space between the parts of a JSON text, which then takes an eighth less room deflated.
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

// Checks a result and returns its engine_identity(). Realisations with results have means, others do not.
// Throws ResultError naming the first invalid value and what is allowed.
std::string check_shape(Json& document) {
  document = checked_part(std::move(document), "");
  check_ending(document);
  check_left_files(document.value("files", Json::array()));
  check_quantities(document);
  if (const std::optional<std::string> pointer = too_large(document)) {
    refuse(*pointer, fmt::format("must be a number between -{0:g} and {0:g}", largest_number));
  }
  return engine_identity(document["engine"]);
}

}  // namespace

ResultError::ResultError(const std::string& message) : std::runtime_error(plain(message)) {}

Json checked_part(Json part, const std::string& root) {
  try {
    return result_keys().validate(std::move(part), "", root);
  } catch (const InputError& error) {
    throw ResultError(error.within("", root).what());
  }
}

std::string engine_identity(const Json& engine) {
  const Json checked = checked_part(engine, "/engine");
  return fmt::format("{} ({}) sha256 {}", checked["version"].get<std::string>(),
                     checked["instruction_set"].get<std::string>(),
                     checked["binary_sha256"].get<std::string>());
}

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
