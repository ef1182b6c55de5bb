#include "runner/realisation_result.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <utility>

#include "contract/input_error.h"
#include "contract/sha256.h"

namespace peclet::runner {
namespace {

constexpr const char* control_name = "brownian_pairwise";

[[noreturn]] void refuse(const std::string& pointer, std::string_view allowed) {
  throw ResultError(fmt::format("{}: {}", pointer, allowed));
}

const Json& field(const Json& document, const std::string& pointer) {
  const Json::json_pointer where(pointer);
  if (!document.contains(where)) refuse(pointer, "is missing");
  return document.at(where);
}

const std::string& text_at(const Json& document, const std::string& pointer) {
  const Json& value = field(document, pointer);
  if (!value.is_string()) refuse(pointer, "must be text");
  return value.get_ref<const std::string&>();
}

std::int64_t count_at(const Json& document, const std::string& pointer) {
  const Json& value = field(document, pointer);
  if (!value.is_number_integer() || value < 0) refuse(pointer, "must be a whole number >= 0");
  return value.get<std::int64_t>();
}

void check_number(const Json& document, const std::string& pointer) {
  if (!field(document, pointer).is_number()) refuse(pointer, "must be a number");
}

bool is_hash(const std::string& text) {
  return text.size() == 64 && text.find_first_not_of("0123456789abcdef") == std::string::npos;
}

// The reader refuses numbers that are not finite; what is left to check is that they are numbers at all.
void check_shape(const Json& document) {
  if (!document.is_object()) refuse("", "must be an object");
  if (field(document, "/schema_version") != 1) refuse("/schema_version", "must be 1");
  if (!is_hash(text_at(document, "/point"))) refuse("/point", "must be a SHA-256");
  if (count_at(document, "/seed") > std::numeric_limits<int>::max()) refuse("/seed", "is too large");
  const std::string& cause = text_at(document, "/ending/cause");
  // Each engine has its own words for how a realisation can go wrong.
  if (cause.empty() || cause.front() == '-' ||
      cause.find_first_not_of("abcdefghijklmnopqrstuvwxyz-") != std::string::npos)
    refuse("/ending/cause", "must be a word of lower-case letters and hyphens");
  count_at(document, "/ending/step");
  check_number(document, "/cost/cpu_seconds");
  check_number(document, "/cost/wall_seconds");
  const bool completed = cause == "completed";
  // A realisation that could not be packed has no final state.
  if ((completed || !field(document, "/final_state_sha256").is_null()) &&
      !is_hash(text_at(document, "/final_state_sha256"))) {
    refuse("/final_state_sha256", "must be a SHA-256");
  }
  for (const char* const part : {"/mean", "/blocks"}) {
    const Json& value = field(document, part);
    if (completed ? !value.is_object() : !value.is_null()) {
      refuse(part, completed ? "must be an object" : "must be null after this ending");
    }
  }
  engine_identity(field(document, "/engine"));
}

// Time is no part of the physics; the machine, and where it keeps the state of a blow-up, is none either.
std::string content_hash(Json document) {
  document.erase("cost");
  document.erase("engine");
  document["ending"].erase("state");
  return sha256(canonical_json(document));
}

std::optional<double> number_in(const Json& object, const std::string& key) {
  const auto found = object.find(key);
  if (found == object.end() || !found->is_number()) return std::nullopt;
  return found->get<double>();
}

// The mean of the first `parts` of 4 equal parts of a series of blocks; none where it is no such series.
std::optional<double> mean_of_first(const Json& blocks, const std::string& key, int parts) {
  const auto found = blocks.find(key);
  if (found == blocks.end() || !found->is_array() || found->empty() || found->size() % 4 != 0) {
    return std::nullopt;
  }
  const std::size_t count = found->size() * static_cast<std::size_t>(parts) / 4;
  double sum = 0;
  for (std::size_t block = 0; block < count; ++block) {
    if (!(*found)[block].is_number()) return std::nullopt;
    sum += (*found)[block].get<double>();
  }
  return sum / static_cast<double>(count);
}

std::optional<double> sum_of(std::optional<double> value, std::optional<double> control) {
  if (!value || !control) return std::nullopt;
  return *value + *control;
}

// value + control in the first `parts` of 4 parts of the window.
std::optional<double> beginning(const Json& blocks, const std::string& observable, bool controlled,
                                int parts) {
  if (!blocks.is_object()) return std::nullopt;
  const std::optional<double> value = mean_of_first(blocks, observable, parts);
  if (!controlled) return value;
  const auto controls = blocks.find("control_variates");
  if (controls == blocks.end() || !controls->is_object()) return std::nullopt;
  return sum_of(value, mean_of_first(*controls, control_name, parts));
}

}  // namespace

RealisationResult parse_result(std::string_view text) {
  RealisationResult result;
  try {
    result.document = parse_json(text, "result");
  } catch (const InputError& error) {
    throw ResultError(error.what());
  }
  check_shape(result.document);
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

std::string engine_identity(const Json& engine) {
  return fmt::format("{} ({}) sha256 {}", text_at(engine, "/version"), text_at(engine, "/instruction_set"),
                     text_at(engine, "/binary_sha256"));
}

std::set<std::string> flags_of(const RealisationResult& result) {
  std::set<std::string> codes;
  if (!result.completed()) return codes;
  for (const Json& warning : result.document.value("warnings", Json::array())) {
    const std::string code = text_at(warning, "/code");
    if (!code.starts_with("inertia-")) codes.insert(code);
  }
  return codes;
}

bool has_observable(const Json& mean, const std::string& observable) {
  const auto found = mean.find(observable);
  return found != mean.end() && (found->is_number() || found->is_null());
}

std::string names_of_numbers(const Json& mean) {
  std::string names;
  for (const auto& [name, value] : mean.items()) {
    if (value.is_number()) names += (names.empty() ? "" : ", ") + name;
  }
  return names;
}

Observed observe(const Json& result, const std::string& observable) {
  Observed observed;
  const Json& mean = result.at("mean");
  if (!mean.is_object()) return observed;
  observed.value = number_in(mean, observable);
  const auto controls = mean.find("control_variates");
  if (observable.starts_with("relative_viscosity") && controls != mean.end()) {
    observed.control = number_in(*controls, control_name);
  }
  const Json& blocks = result.at("blocks");
  observed.first_quarter = beginning(blocks, observable, observed.control.has_value(), 1);
  observed.first_half = beginning(blocks, observable, observed.control.has_value(), 2);
  return observed;
}

std::string cause_of(const RealisationResult& result, const Observed& observed) {
  return result.completed() && !observed.value ? no_value : result.cause;
}

}  // namespace peclet::runner
