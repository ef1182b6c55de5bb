#include "runner/store/realisation_result.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include "contract/errors.h"
#include "contract/frames.h"
#include "contract/sha256.h"
#include "runner/campaign/campaign.h"
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

constexpr std::size_t longest_word = 64;
constexpr std::size_t longest_name = 120;                          // of a version or an instruction set
constexpr std::int64_t largest_count = std::int64_t{1} << 53;      // every double below it is whole or not
constexpr const char* lower_case = "abcdefghijklmnopqrstuvwxyz-";  // of a cause
constexpr const char* lower_or_digit = "abcdefghijklmnopqrstuvwxyz0123456789-";

[[noreturn]] void refuse(const std::string& pointer, std::string_view allowed) {
  throw ResultError(fmt::format("{}: {}", plain(pointer, longest_name), allowed));
}

// A place in the document and what is there.
struct Place {
  const Json& value;
  std::string pointer;

  // Nothing is refused that is absent.
  template <typename Judge>
  void with(const std::string& key, const Judge& judge) const {
    const auto found = value.find(key);
    if (found != value.end()) judge(Place{*found, pointer + '/' + key});
  }
  Place at(const std::string& key) const {
    if (!value.is_object()) refuse(pointer, "must be an object");
    const auto found = value.find(key);
    if (found == value.end()) refuse(pointer + '/' + key, "is missing");
    return {*found, pointer + '/' + key};
  }
};

void must_be_object(const Place& place) {
  if (!place.value.is_object()) refuse(place.pointer, "must be an object");
}

// How large it may be is judged for all numbers together.
void must_be_number(const Place& place) {
  if (!place.value.is_number()) refuse(place.pointer, "must be a number");
}

void must_be_number_or_null(const Place& place) {
  if (!place.value.is_null() && !place.value.is_number()) refuse(place.pointer, "must be a number or null");
}

void must_be_seconds(const Place& place) {
  must_be_number(place);
  if (place.value.get<double>() < 0) refuse(place.pointer, "must be a number >= 0");
}

void must_be_count(const Place& place, std::int64_t end) {
  const double number = place.value.is_number() ? place.value.get<double>() : -1;
  if (!(number >= 0 && number < static_cast<double>(end)) || std::trunc(number) != number) {
    refuse(place.pointer, fmt::format("must be a whole number, at least 0 and below {}", end));
  }
}

void must_be_step(const Place& place) { must_be_count(place, largest_count); }

void must_be_text_or_null(const Place& place) {
  if (!place.value.is_null() && !place.value.is_string()) refuse(place.pointer, "must be text or null");
}

const std::string& text_at(const Place& place) {
  if (!place.value.is_string()) refuse(place.pointer, "must be text");
  return place.value.get_ref<const std::string&>();
}

void must_be_text(const Place& place) { text_at(place); }

// Each engine has its own words for how a realisation can go wrong, and for what it warns of.
const std::string& word_at(const Place& place, const char* letters) {
  const std::string& word = text_at(place);
  const bool is_word = !word.empty() && word.size() <= longest_word && word.front() != '-' &&
                       word.find_first_not_of(letters) == std::string::npos;
  if (!is_word) {
    refuse(place.pointer,
           fmt::format("must be a word of at most {} of the characters {}", longest_word, letters));
  }
  return word;
}

void must_be_hash(const Place& place) {
  const std::string& text = text_at(place);
  if (text.size() != 64 || text.find_first_not_of("0123456789abcdef") != std::string::npos) {
    refuse(place.pointer, "must be a SHA-256 in lower-case hexadecimal");
  }
}

bool is_name(const std::string& text) { return !text.empty() && plain(text, longest_name) == text; }

void must_be_name(const Place& place) {
  if (is_name(text_at(place))) return;
  refuse(place.pointer,
         fmt::format("must be a name of 1 to {} bytes without control characters", longest_name));
}

void must_be_warning(const Place& place) {
  must_be_object(place);
  word_at(place.at("code"), lower_or_digit);
  must_be_text(place.at("message"));
}

void check_warnings(const Place& warnings) {
  if (!warnings.value.is_array()) refuse(warnings.pointer, "must be a list");
  for (std::size_t i = 0; i < warnings.value.size(); ++i) {
    must_be_warning({warnings.value[i], fmt::format("{}/{}", warnings.pointer, i)});
  }
}

void check_members(const Place& object, void (*judge)(const Place&)) {
  must_be_object(object);
  for (const auto& [key, value] : object.value.items()) judge({value, object.pointer + '/' + key});
}

// What a mean consists of is the engine's business; the runner takes numbers from it by their paths, and
// shows these.
void check_mean(const Place& mean) {
  for (const auto& [name, value] : mean.value.items()) {
    if (value.is_number()) continue;
    const std::string pointer = mean.pointer + '/' + name;
    if (!value.is_null() && !value.is_structured()) {
      refuse(pointer, "must be a number, null, a list or an object");
    }
    if (value.is_structured()) check_mean({value, pointer});
  }
  if (!mean.value.is_object()) return;
  for (const auto& [name, value] : mean.value.items()) {
    if (is_name(name)) continue;
    refuse(mean.pointer + '/' + name,
           fmt::format("must have a name of 1 to {} bytes without control characters", longest_name));
  }
}

void check_axes(const Place& axes) {
  if (!axes.value.is_array()) refuse(axes.pointer, "must be a list");
  for (std::size_t i = 0; i < axes.value.size(); ++i) {
    const Place axis{axes.value[i], fmt::format("{}/{}", axes.pointer, i)};
    const Place values = axis.at("values");
    for (const char* const key : {"name", "unit"}) must_be_name(axis.at(key));
    if (!values.value.is_array() || values.value.empty())
      refuse(values.pointer, "must be a list of one or more");
    for (std::size_t k = 0; k < values.value.size(); ++k) {
      const Place value{values.value[k], fmt::format("{}/{}", values.pointer, k)};
      if (!value.value.is_number()) must_be_name(value);
    }
  }
}

// Lists within lists as long as the axes from `axis` on, of numbers and nulls.
bool has_shape(const Json& value, const std::vector<QuantityAxis>& axes, std::size_t axis = 0) {
  if (axis == axes.size()) return value.is_number() || value.is_null();
  return value.is_array() && value.size() == axes[axis].values.size() &&
         std::all_of(value.begin(), value.end(),
                     [&](const Json& element) { return has_shape(element, axes, axis + 1); });
}

void check_description(const Place& about) {
  must_be_name(about.at("unit"));
  if (const Place symbol = about.at("symbol"); !text_at(symbol).empty()) must_be_name(symbol);
  about.with("axes", check_axes);
  const std::string& estimator = text_at(about.at("estimator"));
  if (estimator != "mean" && estimator != "ratio" && estimator != "share")
    refuse(about.pointer + "/estimator", "must be mean, ratio or share");
  if (estimator == "share") {
    for (const char* const key : {"axes", "control"}) {
      about.with(key, [](const Place& place) {
        refuse(place.pointer, "must not be there beside the estimator share");
      });
    }
  }
  if (estimator == "ratio") {
    for (const char* const key : {"numerator", "denominator"}) must_be_name(about.at(key));
  }
  about.with("control", [](const Place& control) {
    text_at(control.at("quantity"));
    must_be_number(control.at("mean"));
  });
}

// Estimates have room for as many numbers as the axes say, whatever the mean has.
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

// A campaign aims at a number by its path: no two may have the same.
void check_paths(const std::vector<Quantity>& all) {
  std::set<std::string_view> paths;
  for (const Quantity& quantity : all) {
    if (!paths.insert(quantity.name).second)
      refuse("/mean/" + quantity.name, "must not be there by two ways");
  }
}

// Whether its values in the mean are what the description says.
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
  if (!is_another || control->ratio || quantity.ratio || sizes(*control) != sizes(quantity)) {
    refuse(fmt::format("/quantities/{}/control/quantity", quantity.name),
           "must be another quantity of the same shape, both of the estimator mean");
  }
}

void check_quantities(const Place& quantities, const Json& document) {
  if (quantities.value.is_null()) return;
  must_be_object(quantities);
  if (quantities.value.empty()) return;  // the engine does not say
  if (!document.at("mean").is_object()) refuse(quantities.pointer, "must be null after this ending");
  for (const auto& [name, value] : quantities.value.items()) {
    const Place about{value, quantities.pointer + '/' + name};
    if (!is_name(name)) {
      refuse(about.pointer,
             fmt::format("must have a name of 1 to {} bytes without control characters", longest_name));
    }
    must_be_object(about);
    check_description(about);
  }
  const std::vector<Quantity> all = quantities_of(document);
  check_sizes(all);
  for (const Quantity& quantity : all) check_values(quantity, all, document.at("mean"));
}

void check_ending(const Place& document) {
  const Place ending = document.at("ending");
  must_be_object(ending);
  const bool completed = has_results(word_at(ending.at("cause"), lower_case));
  must_be_step(ending.at("step"));
  ending.with("message", must_be_text);
  ending.with("state", must_be_text_or_null);
  // A realisation that could not be packed has no final state.
  const Place state = document.at("final_state_sha256");
  if (completed || !state.value.is_null()) must_be_hash(state);
  for (const char* const part : {"mean", "blocks"}) {
    const Place about = document.at(part);
    if (completed ? !about.value.is_object() : !about.value.is_null()) {
      refuse(about.pointer, completed ? "must be an object" : "must be null after this ending");
    }
  }
  if (!completed) return;
  check_mean(document.at("mean"));
  const auto descriptions = document.value.find("quantities");
  if (descriptions == document.value.end() || descriptions->empty())
    check_paths(quantities_of(document.value));
}

// The pointer of a number that is too large; the reader has refused those that are not finite. It is put
// together on the way back, because a result has thousands of numbers, and none of them should be.
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

}  // namespace

ResultError::ResultError(const std::string& message) : std::runtime_error(plain(message)) {}

std::string check_shape(const Json& document) {
  const Place whole{document, ""};
  if (!document.is_object()) throw ResultError("must be an object");
  if (whole.at("schema_version").value != 1) refuse("/schema_version", "must be 1");
  must_be_hash(whole.at("point"));
  must_be_count(whole.at("seed"), most_realisations);
  check_ending(whole);
  for (const char* const which : {"cpu_seconds", "wall_seconds"}) must_be_seconds(whole.at("cost").at(which));
  whole.with("steps", [](const Place& steps) { check_members(steps, must_be_step); });
  for (const char* const part : {"strain", "time", "derived"}) {
    whole.with(part, [](const Place& members) { check_members(members, must_be_number_or_null); });
  }
  for (const char* const key : {"timestep", "statistical_inefficiency", "largest_overlap"}) {
    whole.with(key, must_be_number_or_null);
  }
  whole.with("method", must_be_text_or_null);
  whole.with("units", must_be_text);
  whole.with("warnings", check_warnings);
  whole.with("files", [](const Place& files) { check_left_files(files.value); });
  whole.with("quantities", [&](const Place& quantities) { check_quantities(quantities, document); });
  whole.with("gate", [](const Place& gate) {
    if (!gate.value.is_null()) must_be_object(gate);
  });
  const std::string engine = engine_identity(whole.at("engine").value);
  if (const std::optional<std::string> pointer = too_large(document)) {
    refuse(*pointer, fmt::format("must be a number between -{0:g} and {0:g}", largest_number));
  }
  return engine;
}

std::string engine_identity(const Json& engine) {
  const Place place{engine, "/engine"};
  const Place version = place.at("version"), set = place.at("instruction_set");
  const Place hash = place.at("binary_sha256");
  must_be_name(version);
  must_be_name(set);
  must_be_hash(hash);
  return fmt::format("{} ({}) sha256 {}", text_at(version), text_at(set), text_at(hash));
}

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
