#include "engine/pictures/colouring.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "contract/errors.h"

namespace peclet::engine {
namespace {

// Every fifth of the 256 colours of viridis.
constexpr std::array<std::uint32_t, 52> viridis_table = {
    0x440154, 0x46085c, 0x471063, 0x481769, 0x481d6f, 0x482475, 0x472a7a, 0x46307e, 0x453781,
    0x433d84, 0x414287, 0x3f4889, 0x3d4e8a, 0x3a538b, 0x38598c, 0x355e8d, 0x33638d, 0x31688e,
    0x2e6d8e, 0x2c718e, 0x2a768e, 0x297b8e, 0x27808e, 0x25848e, 0x23898e, 0x218e8d, 0x20928c,
    0x1f978b, 0x1e9c89, 0x1fa188, 0x21a585, 0x24aa83, 0x28ae80, 0x2eb37c, 0x35b779, 0x3dbc74,
    0x46c06f, 0x50c46a, 0x5ac864, 0x65cb5e, 0x70cf57, 0x7cd250, 0x89d548, 0x95d840, 0xa2da37,
    0xb0dd2f, 0xbddf26, 0xcae11f, 0xd8e219, 0xe5e419, 0xf1e51d, 0xfde725,
};

// The scheme "light" (colouring.h).
constexpr std::array<std::uint32_t, count_of_species_colours> species_table = {
    0x77aadd, 0xee8866, 0xeedd88, 0x44bb99, 0xffaabb, 0x99ddff, 0xbbcc33, 0xaaaa00};

void require(bool is_there, const std::string& file, const char* what, const char* cure) {
  if (!is_there)
    throw InputError(file, "", "", fmt::format("has no {}, which --colour asks for{}", what, cure));
}

Colouring on_scale(const ColourScale& scale, const std::vector<double>& values) {
  Colouring all;
  all.scale = {scale};
  for (const double value : values) all.of_spheres.push_back(scale.at(value));
  return all;
}

// Colours more species than there are colours: by radius on a scale, or by index if all radii are equal.
Colouring by_radius(const Snapshot& snapshot, const std::vector<ColourScale>& given) {
  const auto [low, high] = std::minmax_element(snapshot.radius.begin(), snapshot.radius.end());
  if (!given.empty()) return on_scale(given.front(), snapshot.radius);
  if (*low < *high) return on_scale({"radius", *low, *high}, snapshot.radius);
  return on_scale({"species", 0, static_cast<double>(snapshot.species_names.size() - 1)},
                  {snapshot.species.begin(), snapshot.species.end()});
}

Colouring by_species(const Snapshot& snapshot, const std::vector<ColourScale>& given) {
  if (snapshot.species_names.size() > count_of_species_colours) return by_radius(snapshot, given);
  Colouring all;
  std::vector<double> radius(snapshot.species_names.size(), 0);
  std::vector<bool> is_one_size(radius.size(), true);
  for (std::size_t i = 0; i < snapshot.count(); ++i) {
    const std::uint32_t s = snapshot.species[i];
    is_one_size[s] = is_one_size[s] && (radius[s] == 0 || radius[s] == snapshot.radius[i]);
    radius[s] = snapshot.radius[i];
    all.of_spheres.push_back(colour_of_species(s));
  }
  for (std::size_t s = 0; s < radius.size(); ++s) {
    if (radius[s] == 0) continue;
    const std::string size =
        is_one_size[s] ? fmt::format("a = {:.4g}", radius[s]) : snapshot.species_names[s];
    all.names.push_back({size, colour_of_species(s)});
  }
  return all;
}

// Returns the velocity gradient of the file, or that of simple shear from strain and time, or 0.
Matrix3 mean_flow(const Snapshot& snapshot) {
  if (snapshot.velocity_gradient) return *snapshot.velocity_gradient;
  const bool flows = snapshot.strain && snapshot.time && *snapshot.time > 0;
  return simple_shear(flows ? *snapshot.strain / *snapshot.time : 0);
}

std::pair<std::string, std::vector<double>> speeds(const Snapshot& snapshot) {
  const Matrix3 flow = mean_flow(snapshot);
  std::vector<double> values;
  for (std::size_t i = 0; i < snapshot.count(); ++i) {
    values.push_back(norm(snapshot.velocity[i] - flow * snapshot.position[i]));
  }
  return {flow == Matrix3{} ? "speed" : "non-affine speed", values};
}

}  // namespace

float linear_of(double encoded) {
  return static_cast<float>(encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4));
}

Colour colour_of(std::uint32_t rgb) {
  const auto part = [rgb](int shift) { return linear_of(((rgb >> shift) & 0xff) / 255.0); };
  return {part(16), part(8), part(0)};
}

std::uint8_t encoded(float linear) {
  // Fine enough for the darkest steps, which are 1/3295 of white.
  static const std::vector<std::uint8_t> table = [] {
    std::vector<std::uint8_t> all(65536);
    for (std::size_t k = 0; k < all.size(); ++k) {
      const double x = static_cast<double>(k) / 65535;
      all[k] = static_cast<std::uint8_t>(
          std::lround(255 * (x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055)));
    }
    return all;
  }();
  return table[static_cast<std::size_t>(std::lround(65535 * std::clamp(linear, 0.0F, 1.0F)))];
}

Colour viridis(double place) {
  const double at = std::clamp(place, 0.0, 1.0) * (viridis_table.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(at), viridis_table.size() - 2);
  const double share = at - static_cast<double>(below);
  const auto part = [&](int shift) {
    const double low = (viridis_table[below] >> shift) & 0xff,
                 high = (viridis_table[below + 1] >> shift) & 0xff;
    return linear_of((low + share * (high - low)) / 255);
  };
  return {part(16), part(8), part(0)};
}

Colour colour_of_species(std::size_t species) { return colour_of(species_table.at(species)); }

const std::vector<std::string>& names_of_colourings() {
  static const std::vector<std::string> names = {"species", "speed", "contacts", "stress"};
  return names;
}

ColourScale scale_over(const std::string& title, std::vector<double> values) {
  const auto percentile = [&](std::size_t share) {
    const auto place = values.begin() + static_cast<std::ptrdiff_t>((values.size() - 1) * share / 100);
    std::nth_element(values.begin(), place, values.end());
    return *place;
  };
  const double low = percentile(2), high = percentile(98);
  // Values that are nearly equal get a wider scale, on which ticks differ.
  const bool is_wide = high - low > 1e-9 * std::max(std::abs(low), std::abs(high));
  return {title, low, is_wide ? high : low + std::max(1e-12, std::abs(low))};
}

std::vector<double> ticks_of(const ColourScale& scale) {
  const double width = scale.high - scale.low, power = std::pow(10, std::floor(std::log10(width / 5)));
  double step = 10 * power;
  for (const double factor : {5.0, 2.0, 1.0}) {
    if (width / (factor * power) < 7.5) step = factor * power;
  }
  std::vector<double> ticks;
  for (double k = std::ceil(scale.low / step - 1e-9); k * step <= scale.high + 1e-9 * width; ++k) {
    ticks.push_back(k == 0 ? 0 : k * step);
  }
  return ticks;
}

Colouring colouring_of(const Snapshot& snapshot, const std::string& name, const std::string& file,
                       const std::vector<ColourScale>& given) {
  if (name == "species") return by_species(snapshot, given);
  std::string title;
  std::vector<double> values;
  if (name == "speed") {
    require(!snapshot.velocity.empty(), file, "velocities", "");
    std::tie(title, values) = speeds(snapshot);
  } else if (name == "contacts") {
    require(!snapshot.contact_number.empty(), file, "numbers of contacts",
            ": a trajectory of a scene with contacts has them");
    title = "contacts";
    values.assign(snapshot.contact_number.begin(), snapshot.contact_number.end());
  } else if (name == "stress") {
    require(!snapshot.stress.empty(), file, "stresses of spheres", ": a trajectory has them");
    title = "stress xy";
    for (std::size_t i = 0; i < snapshot.count(); ++i) {
      const double a = snapshot.radius[i];
      values.push_back(snapshot.stress[i].xy / (4.0 / 3.0 * std::numbers::pi * a * a * a));
    }
  } else {
    throw std::logic_error("unknown colouring: " + name);
  }
  return on_scale(given.empty() ? scale_over(title, values) : given.front(), values);
}

}  // namespace peclet::engine
