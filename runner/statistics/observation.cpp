#include "runner/statistics/observation.h"

#include <optional>
#include <string_view>

#include "runner/statistics/quantities.h"

namespace peclet::runner {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

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

void append_observation(const Json& result, const std::string& path, std::vector<double>& numbers) {
  std::optional<ControlVariate> control = control_of(result, path);
  std::optional<double> controlling;
  if (control) controlling = number_at(result.at("mean"), control->quantity);
  if (!controlling) control.reset();
  numbers.push_back(number_at(result.at("mean"), path).value_or(none));
  numbers.push_back(control ? *controlling - control->mean : none);
  const Json& blocks = result.at("blocks");
  for (const int quarters : {1, 2})
    numbers.push_back(beginning(blocks, path, control, quarters).value_or(none));
}

Observation observation_of(std::span<const double> numbers, bool is_share) {
  return {numbers[0], std::isnan(numbers[1]) ? 0 : numbers[1], numbers[2], numbers[3], is_share};
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
    values.push_back(value.value_or(none));
  }
  return values;
}

bool has_observable(const Json& mean, const std::string& observable) {
  const Json* const found = at_path(mean, observable);
  return found != nullptr && (found->is_number() || found->is_null());
}

std::string lacking_in(const Json& result, const std::vector<std::string>& observables) {
  for (const std::string& observable : observables) {
    if (!has_observable(result.at("mean"), observable)) return observable;
  }
  return "";
}

}  // namespace peclet::runner
