#include "engine/evaluation/configuration.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "contract/input_error.h"
#include "engine/scene/lubrication_block.h"

namespace peclet::engine {
namespace {

std::vector<Key> vector_keys(const std::string& pointer, const std::string& meaning, const std::string& unit,
                             bool required) {
  return {
      {.pointer = pointer, .kind = KeyKind::array, .meaning = meaning, .unit = unit, .required = required},
      {.pointer = pointer + "/*",
       .kind = KeyKind::array,
       .meaning = "components x, y, z",
       .minimum_items = 3},
      {.pointer = pointer + "/*/*", .kind = KeyKind::number, .meaning = "component"}};
}

std::vector<Key> single_vector_keys(const std::string& pointer, const std::string& meaning, KeyKind kind) {
  return {
      {.pointer = pointer, .kind = KeyKind::array, .meaning = meaning, .required = true, .minimum_items = 3},
      {.pointer = pointer + "/*", .kind = kind, .meaning = "component"}};
}

std::vector<Key> pair_keys(const std::string& pointer, const std::string& meaning,
                           const std::vector<std::pair<std::string, std::string>>& vectors) {
  std::vector<Key> keys = {{.pointer = pointer, .kind = KeyKind::array, .meaning = meaning},
                           {.pointer = pointer + "/*", .kind = KeyKind::object, .meaning = "one pair"},
                           {.pointer = pointer + "/*/i",
                            .kind = KeyKind::integer,
                            .meaning = "first particle",
                            .required = true,
                            .minimum = 0},
                           {.pointer = pointer + "/*/j",
                            .kind = KeyKind::integer,
                            .meaning = "second particle, above i",
                            .required = true,
                            .minimum = 0}};
  const auto append = [&keys](const std::vector<Key>& more) {
    keys.insert(keys.end(), more.begin(), more.end());
  };
  append(single_vector_keys(pointer + "/*/image",
                            "lattice vectors added to the second particle's position as given",
                            KeyKind::integer));
  for (const auto& [name, text] : vectors) {
    append(single_vector_keys(pointer + "/*/" + name, text, KeyKind::number));
  }
  return keys;
}

Vector3 vector_from(const Json& array) {
  return {array.at(0).get<double>(), array.at(1).get<double>(), array.at(2).get<double>()};
}

class Reader {
 public:
  Reader(const Json& document, std::string file) : document_(document), file_(std::move(file)) {}

  Configuration read() {
    const Json& state = document_.at("state");
    Configuration configuration;
    configuration.physics = read_physics(document_.at("scene"), file_, "/scene");
    const auto radius = state.at("radius").get<std::vector<double>>();
    check_lubrication(configuration.physics, radius);
    configuration.particles = make_particles(radius, 1);
    ParticleState& particles = configuration.particles;
    particles.position = field("/state/position", radius.size());
    particles.velocity = field("/state/velocity", radius.size());
    particles.angular_velocity = field("/state/angular_velocity", radius.size());
    check_three("/state/box/lengths");
    configuration.box = PeriodicCell(vector_from(state.at("box").at("lengths")),
                                     configuration.physics.flow.deformation().velocity_gradient(0),
                                     state.at("box").at("tilt").get<double>());
    for (std::size_t k = 0; k < state.value("springs", Json::array()).size(); ++k) {
      const std::string at = fmt::format("/state/springs/{}", k);
      const PairName name = pair_name(at, radius.size());
      const double slides = this->at(at).at("slides").get<bool>() ? 1 : 0;
      configuration.springs.push_back({name.first,
                                       name.second,
                                       name.image,
                                       {vector(at + "/tangential"), vector(at + "/rolling"), slides}});
    }
    if (state.contains("noise")) {
      configuration.noise = noise(radius.size());
    }
    if (document_.contains("advance")) {
      configuration.advance = document_.at("advance").get<double>();
    }
    return configuration;
  }

 private:
  struct PairName {
    std::uint32_t first, second;
    LatticeShift image;
  };

  const Json& at(const std::string& pointer) const { return document_.at(Json::json_pointer(pointer)); }

  [[noreturn]] void refuse(const std::string& pointer, const std::string& value,
                           const std::string& allowed) const {
    throw InputError(file_, pointer, value, allowed);
  }

  void check_lubrication(const Physics& physics, const std::vector<double>& radius) const {
    if (!physics.lubrication || radius.empty()) return;
    const std::optional<std::string> fault =
        fault_of_outer_distance(*physics.lubrication, *std::ranges::min_element(radius));
    if (fault) {
      const std::string pointer = "/scene/lubrication/outer_distance";
      refuse(pointer, shortened(at(pointer)), *fault);
    }
  }

  void check_three(const std::string& pointer) const {
    if (at(pointer).size() != 3) {
      refuse(pointer, at(pointer).dump(), "must have three components");
    }
  }

  Vector3 vector(const std::string& pointer) const {
    check_three(pointer);
    return vector_from(at(pointer));
  }

  VectorField field(const std::string& pointer, std::size_t count) const {
    if (at(pointer).size() != count) {
      refuse(pointer, fmt::format("{} vectors", at(pointer).size()),
             fmt::format("must have {}, as many as radii", count));
    }
    VectorField field(count);
    for (std::size_t i = 0; i < count; ++i) {
      field.set(i, vector(fmt::format("{}/{}", pointer, i)));
    }
    return field;
  }

  PairName pair_name(const std::string& pointer, std::size_t count) const {
    const Json& entry = at(pointer);
    const auto i = entry.at("i").get<std::uint64_t>(), j = entry.at("j").get<std::uint64_t>();
    if (i >= j || j >= count) {
      refuse(pointer + "/j", std::to_string(j), fmt::format("must be above i = {} and below {}", i, count));
    }
    check_three(pointer + "/image");
    const auto image = entry.at("image").get<std::vector<std::int32_t>>();
    return {static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j), {image[0], image[1], image[2]}};
  }

  GivenNoise noise(std::size_t count) const {
    GivenNoise noise;
    noise.timestep = at("/state/noise/timestep").get<double>();
    noise.force = field("/state/noise/force", count);
    noise.torque = field("/state/noise/torque", count);
    for (std::size_t k = 0; k < at("/state/noise").value("pairs", Json::array()).size(); ++k) {
      const std::string pointer = fmt::format("/state/noise/pairs/{}", k);
      const PairName name = pair_name(pointer, count);
      noise.pairs.push_back(
          {name.first, name.second, name.image, {vector(pointer + "/theta"), vector(pointer + "/chi")}});
    }
    return noise;
  }

  const Json& document_;
  std::string file_;
};

}  // namespace

const KeyTable& configuration_keys() {
  static const KeyTable table = [] {
    std::vector<Key> keys = {
        {.pointer = "/scene",
         .kind = KeyKind::any,
         .meaning = fmt::format("the blocks {} of a scene", fmt::join(blocks_of_physics(), ", ")),
         .required = true},
        {.pointer = "/advance",
         .kind = KeyKind::number,
         .meaning = "time by which the springs are advanced",
         .unit = "time",
         .minimum = 0},
        {.pointer = "/state", .kind = KeyKind::object, .meaning = "the configuration", .required = true},
        {.pointer = "/state/box", .kind = KeyKind::object, .meaning = "the periodic cell", .required = true}};
    const auto append = [&keys](const std::vector<Key>& more) {
      keys.insert(keys.end(), more.begin(), more.end());
    };
    keys.push_back({.pointer = "/state/box/lengths",
                    .kind = KeyKind::array,
                    .meaning = "Lx, Ly, Lz",
                    .unit = "length",
                    .required = true,
                    .minimum_items = 3});
    keys.push_back({.pointer = "/state/box/lengths/*",
                    .kind = KeyKind::number,
                    .meaning = "edge",
                    .minimum = 0,
                    .above_minimum = true});
    keys.push_back({.pointer = "/state/box/tilt",
                    .kind = KeyKind::number,
                    .meaning = "x component of the second lattice vector",
                    .unit = "length",
                    .default_value = 0.0});
    keys.push_back({.pointer = "/state/radius",
                    .kind = KeyKind::array,
                    .meaning = "radii",
                    .unit = "length",
                    .required = true,
                    .minimum_items = 1});
    keys.push_back({.pointer = "/state/radius/*",
                    .kind = KeyKind::number,
                    .meaning = "radius",
                    .minimum = 0,
                    .above_minimum = true});
    append(vector_keys("/state/position", "centres", "length", true));
    append(vector_keys("/state/velocity", "velocities in the laboratory frame", "length / time", true));
    append(vector_keys("/state/angular_velocity", "angular velocities", "1 / time", true));
    append(pair_keys("/state/springs", "contact springs",
                     {{"tangential", "sliding spring"}, {"rolling", "rolling spring"}}));
    keys.push_back({.pointer = "/state/springs/*/slides",
                    .kind = KeyKind::boolean,
                    .meaning = "whether the contact slides, with kinetic friction",
                    .default_value = false});
    keys.push_back({.pointer = "/state/noise", .kind = KeyKind::object, .meaning = "random vectors to use"});
    keys.push_back({.pointer = "/state/noise/timestep",
                    .kind = KeyKind::number,
                    .meaning = "dt of the amplitude sqrt(2 kT / dt)",
                    .unit = "time",
                    .required = true,
                    .minimum = 0,
                    .above_minimum = true});
    append(vector_keys("/state/noise/force", "normal vectors of the forces", "", true));
    append(vector_keys("/state/noise/torque", "normal vectors of the torques", "", true));
    append(pair_keys("/state/noise/pairs", "normal vectors of pairs",
                     {{"theta", "of force and turning"}, {"chi", "of the spins"}}));
    return KeyTable("configuration", keys);
  }();
  return table;
}

Configuration read_configuration(const Json& document, const std::string& file) {
  return Reader(configuration_keys().validate(document, file), file).read();
}

}  // namespace peclet::engine
