#include "runner/folder/realisation_result.h"

#include <utility>

#include "contract/input_error.h"
#include "contract/sha256.h"

namespace peclet::runner {
namespace {

constexpr const char* control_name = "brownian_pairwise";

// Time is no part of the physics; the machine, and where it keeps the state of a blow-up, is none either.
std::string content_hash(Json& document) {
  // A result may be large, so these parts are laid aside, not the others copied.
  const auto take = [](Json& object, const char* key) {
    Json part = std::move(object[key]);
    object.erase(key);
    return part;
  };
  Json& ending = document["ending"];
  const bool has_state = ending.contains("state");
  Json cost = take(document, "cost"), engine = take(document, "engine"), state = take(ending, "state");
  const std::string hash = sha256(canonical_json(document));
  document["cost"] = std::move(cost);
  document["engine"] = std::move(engine);
  if (has_state) ending["state"] = std::move(state);
  return hash;
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
  if (const std::string excess = excess_of(text); !excess.empty()) throw ResultError(excess);
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

std::set<std::string> flags_of(const RealisationResult& result) {
  std::set<std::string> codes;
  if (!result.completed()) return codes;
  for (const Json& warning : result.document.value("warnings", Json::array())) {
    const std::string& code = warning.at("code").get_ref<const std::string&>();
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
