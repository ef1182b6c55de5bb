#include "runner/folder/realisation_result.h"

#include <cmath>
#include <utility>

#include "contract/input_error.h"
#include "contract/sha256.h"
#include "runner/statistics/quantities.h"

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

std::optional<double> number_at(const Json& document, const std::string& path) {
  const Json* const value = at_path(document, path);
  if (value == nullptr || !value->is_number()) return std::nullopt;
  return value->get<double>();
}

// The list of blocks that has the number at a path in each of its elements, and the rest of the path there.
struct Series {
  const Json* blocks = nullptr;
  std::string element;
};

Series series_of(const Json& blocks, const std::string& path) {
  for (std::size_t end = path.find('/', 1);; end = path.find('/', end + 1)) {
    const Json* const found = at_path(blocks, std::string_view(path).substr(0, end));
    if (found != nullptr && found->is_array())
      return {found, end == std::string::npos ? "" : path.substr(end)};
    if (end == std::string::npos) return {};
  }
}

// The mean of the first `parts` of 4 equal parts of a series of blocks; none where it is no such series.
std::optional<double> mean_of_first(const Json& blocks, const std::string& path, int parts) {
  const Series series = series_of(blocks, path);
  if (series.blocks == nullptr || series.blocks->empty() || series.blocks->size() % 4 != 0) {
    return std::nullopt;
  }
  const std::size_t count = series.blocks->size() * static_cast<std::size_t>(parts) / 4;
  double sum = 0;
  for (std::size_t block = 0; block < count; ++block) {
    const std::optional<double> value = number_at((*series.blocks)[block], series.element);
    if (!value) return std::nullopt;
    sum += *value;
  }
  return sum / static_cast<double>(count);
}

// value + control in the first `parts` of 4 parts of the window.
std::optional<double> beginning(const Json& blocks, const std::string& observable,
                                const std::optional<ControlVariate>& control, int parts) {
  if (!blocks.is_object()) return std::nullopt;
  const std::optional<double> value = mean_of_first(blocks, observable, parts);
  if (!control || !value) return value;
  const std::optional<double> controlling = mean_of_first(blocks, control->quantity, parts);
  if (!controlling) return std::nullopt;
  return *value + *controlling - control->mean;
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

bool has_observable(const Json& mean, const std::string& observable) {
  const Json* const found = at_path(mean, observable);
  return found != nullptr && (found->is_number() || found->is_null());
}

Observed observe(const Json& result, const std::string& observable) {
  Observed observed;
  const Json& mean = result.at("mean");
  if (!mean.is_object()) return observed;
  observed.value = number_at(mean, observable);
  std::optional<ControlVariate> control = control_of(result, observable);
  if (control) {
    const std::optional<double> value = number_at(mean, control->quantity);
    if (value) observed.control = *value - control->mean;
    if (!value) control.reset();
  }
  const Json& blocks = result.at("blocks");
  observed.first_quarter = beginning(blocks, observable, control, 1);
  observed.first_half = beginning(blocks, observable, control, 2);
  return observed;
}

std::vector<double> block_values(const Json& result, const std::string& observable) {
  const Json& blocks = result.at("blocks");
  const Series series = blocks.is_object() ? series_of(blocks, observable) : Series{};
  if (series.blocks == nullptr) return {};
  const std::optional<ControlVariate> control = control_of(result, observable);
  const Series controlling = control ? series_of(blocks, control->quantity) : Series{};
  const bool controlled =
      controlling.blocks != nullptr && controlling.blocks->size() == series.blocks->size();
  std::vector<double> values;
  for (std::size_t block = 0; block < series.blocks->size(); ++block) {
    std::optional<double> value = number_at((*series.blocks)[block], series.element);
    if (value && controlled) {
      const std::optional<double> beside = number_at((*controlling.blocks)[block], controlling.element);
      value = beside ? std::optional(*value + *beside - control->mean) : std::nullopt;
    }
    values.push_back(value.value_or(std::nan("")));
  }
  return values;
}

std::vector<Observed> observe(const Json& result, const std::vector<std::string>& observables) {
  const std::vector<Quantity> quantities = quantities_of(result);
  std::vector<Observed> observed;
  observed.reserve(observables.size());
  for (const std::string& observable : observables) {
    observed.push_back(observe(result, observable));
    observed.back().is_share = is_share(quantities, observable);
  }
  return observed;
}

std::string lacking_in(const Json& result, const std::vector<std::string>& observables) {
  for (const std::string& observable : observables) {
    if (!has_observable(result.at("mean"), observable)) return observable;
  }
  return "";
}

std::string cause_of(const RealisationResult& result, const Observed& observed) {
  return result.completed() && !observed.value ? no_value : result.cause;
}

}  // namespace peclet::runner
