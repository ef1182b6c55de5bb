#include "runner/statistics/quantities.h"

#include <algorithm>
#include <charconv>
#include <optional>
#include <string_view>
#include <utility>

namespace peclet::runner {

namespace {

std::string_view without_slash(std::string_view path) {
  return path.starts_with('/') ? path.substr(1) : path;
}

// Removes the part before the first slash from the path and returns it.
std::string_view take_part(std::string_view& path) {
  const std::size_t slash = path.find('/');
  const std::string_view part = path.substr(0, slash);
  path = slash == std::string_view::npos ? std::string_view() : path.substr(slash + 1);
  return part;
}

std::optional<std::size_t> index_in(std::string_view part) {
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), index);
  if (error != std::errc() || end != part.data() + part.size()) return std::nullopt;
  return index;
}

const Json* below(const Json& value, std::string_view path);

const Json* element_below(const Json& list, std::string_view path) {
  const std::optional<std::size_t> index = index_in(take_part(path));
  return index && *index < list.size() ? below(list[*index], path) : nullptr;
}

// Returns the value below a member. Names may have slashes: the longest name that leads to a value is taken.
const Json* member_below(const Json& object, std::string_view path) {
  for (std::string_view name = path;; name = name.substr(0, name.rfind('/'))) {
    if (const auto found = object.find(name); found != object.end()) {
      const bool is_whole = name.size() == path.size();
      const Json* const there = below(*found, is_whole ? std::string_view() : path.substr(name.size() + 1));
      if (there != nullptr) return there;
    }
    if (name.find('/') == std::string_view::npos) return nullptr;
  }
}

const Json* below(const Json& value, std::string_view path) {
  if (path.empty()) return &value;
  if (value.is_object()) return member_below(value, path);
  return value.is_array() ? element_below(value, path) : nullptr;
}

Quantity described(const std::string& name, const Json& about) {
  Quantity quantity{name, about.at("symbol").get<std::string>(), about.at("unit").get<std::string>()};
  quantity.axes = about.value("axes", std::vector<QuantityAxis>());
  quantity.is_share = about.at("estimator") == "share";
  if (about.at("estimator") == "ratio") {
    quantity.ratio = RatioOfMeans{about.at("numerator"), about.at("denominator")};
  }
  if (const auto control = about.find("control"); control != about.end()) {
    quantity.control = control->get<ControlVariate>();
  }
  return quantity;
}

// Returns the axis lengths of nested lists of numbers; nothing if they are ragged or have other values.
std::optional<std::vector<std::size_t>> shape_of(const Json& value) {
  if (value.is_number()) return std::vector<std::size_t>();
  if (!value.is_array() || value.empty()) return std::nullopt;
  std::optional<std::vector<std::size_t>> inner;
  for (const Json& element : value) {
    const std::optional<std::vector<std::size_t>> shape = shape_of(element);
    if (!shape || (inner && *inner != *shape)) return std::nullopt;
    inner = shape;
  }
  inner->insert(inner->begin(), value.size());
  return inner;
}

// Returns the control variate of engines that do not describe their numbers: one, of the viscosities.
std::optional<ControlVariate> undescribed_control(const Json& mean, std::string_view path) {
  constexpr const char* control = "control_variates/brownian_pairwise";
  if (!path.starts_with("relative_viscosity")) return std::nullopt;
  const Json* const value = at_path(mean, control);
  if (value == nullptr || !value->is_number()) return std::nullopt;
  return ControlVariate{control, 0};
}

void add_undescribed(const Json& mean, const Json& value, const std::string& name,
                     std::vector<Quantity>& all) {
  const std::optional<std::vector<std::size_t>> shape = shape_of(value);
  if (shape) {
    Quantity quantity{name, "", ""};
    for (const std::size_t count : *shape) {
      Json indices = Json::array();
      for (std::size_t index = 0; index < count; ++index) indices.push_back(index);
      quantity.axes.push_back({"index", "1", std::move(indices)});
    }
    if (shape->empty()) quantity.control = undescribed_control(mean, name);
    all.push_back(std::move(quantity));
    return;
  }
  if (!value.is_structured()) return;
  for (const auto& [key, inner] : value.items()) {
    add_undescribed(mean, inner, name.empty() ? key : name + '/' + key, all);
  }
}

// Returns the descriptions of a result's numbers, or null if there are none.
const Json* descriptions(const Json& result) {
  const auto found = result.find("quantities");
  return found == result.end() || found->empty() ? nullptr : &*found;
}

constexpr double none = std::numeric_limits<double>::quiet_NaN();

std::optional<double> number_at(const Json& document, const std::string& path) {
  const Json* const value = at_path(document, path);
  if (value == nullptr || !value->is_number()) return std::nullopt;
  return value->get<double>();
}

// A list of blocks, and the path of a number within each block.
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

// Returns the mean over the first `parts` quarters of the blocks; nothing if a value is missing or the number
// of blocks is not a multiple of 4.
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

// Returns value + control over the first `parts` quarters of the window.
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

std::size_t Quantity::elements() const {
  std::size_t product = 1;
  for (const QuantityAxis& axis : axes) product *= axis.values.size();
  return product;
}

std::vector<Quantity> quantities_of(const Json& result) {
  std::vector<Quantity> all;
  if (const Json* const about = descriptions(result)) {
    for (const auto& [name, description] : about->items()) all.push_back(described(name, description));
  } else if (const Json& mean = result.at("mean"); mean.is_object()) {
    add_undescribed(mean, mean, "", all);
  }
  return all;
}

const Json* at_path(const Json& document, std::string_view path) {
  return below(document, without_slash(path));
}

std::optional<ControlVariate> control_of(const Json& result, std::string_view path) {
  path = without_slash(path);
  const Json* const about = descriptions(result);
  if (about == nullptr) return undescribed_control(result.at("mean"), path);
  // The path names the quantity itself, or an element of it.
  for (std::string_view name = path;; name = name.substr(0, name.rfind('/'))) {
    if (const auto found = about->find(name); found != about->end()) {
      const auto control = found->find("control");
      if (control == found->end()) return std::nullopt;
      return ControlVariate{
          control->at("quantity").get<std::string>() + std::string(path.substr(name.size())),
          control->at("mean").get<double>()};
    }
    if (name.find('/') == std::string_view::npos) return std::nullopt;
  }
}

const char* estimator_of(const Quantity& quantity) {
  if (quantity.ratio) return "ratio";
  return quantity.is_share ? "share" : "mean";
}

bool is_share(const std::vector<Quantity>& quantities, std::string_view path) {
  path = without_slash(path);
  return std::any_of(quantities.begin(), quantities.end(),
                     [&](const Quantity& quantity) { return quantity.is_share && quantity.name == path; });
}

bool matches(std::string_view pattern, std::string_view path) {
  path = without_slash(path);
  while (!pattern.empty() && !path.empty()) {
    const std::string_view wanted = take_part(pattern), part = take_part(path);
    if (wanted != part && !(wanted == "*" && index_in(part))) return false;
  }
  return pattern.empty() && path.empty();
}

std::string names_of_targets(const Json& result) {
  std::string text;
  for (const Quantity& quantity : quantities_of(result)) {
    if (quantity.ratio) continue;
    text += (text.empty() ? "" : ", ") + quantity.name;
    for (std::size_t axis = 0; axis < quantity.axes.size(); ++axis) text += "/*";
  }
  return text;
}

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
