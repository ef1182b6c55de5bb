#include <fmt/format.h>

#include <map>

#include "contract/text.h"
#include "engine/snapshots/snapshot.h"
#include "engine/snapshots/sphere_text.h"

namespace peclet::engine {
namespace {

class LfDemReading : SphereText {
 public:
  LfDemReading(std::string_view text, const std::string& file) : SphereText(file), rest_(text) {}

  Snapshot read() {
    read_header();
    for (const char* const wall : {"np_fixed", "np_wall1", "radius_in", "z_bot"}) {
      if (header_.contains(wall)) refuse(wall, "must not be there: walls are not available");
    }
    const double x = value_of("lx"), y = value_of("lz"), z = value_of("ly");
    if (!(z > 0)) refuse(fmt::format("ly {}", z), "must be > 0: monolayers are not available");
    const double shift = header_.contains("disp")    ? value_of("disp")
                         : header_.contains("dispx") ? value_of("dispx")
                                                     : 0.0;
    if (header_.contains("dispy") && value_of("dispy") != 0) refuse("dispy", "must be 0");
    Snapshot snapshot;
    snapshot.lattice = {Vector3{x, 0, 0}, Vector3{shift, y, 0}, Vector3{0, 0, z}};
    while (!is_blank(rest_)) {
      std::string_view line = take_line(rest_);
      const std::string where = fmt::format("sphere {}", snapshot.count() + 1);
      const Vector3 place = vector(line, where);
      snapshot.position.push_back({place.x, place.z, place.y});
      snapshot.radius.push_back(number<double>(take_word(line), where));
      if (!is_blank(line)) refuse(where, "must be x, y, z and radius, and no more");
    }
    const double count = value_of("np1") + value_of("np2");
    if (count != static_cast<double>(snapshot.count()))
      refuse(fmt::format("{} spheres", snapshot.count()), "must be np1 + np2 = {}", count);
    finish(snapshot, {});
    return snapshot;
  }

 private:
  void read_header() {
    std::string_view names = take_line(rest_), values = take_line(rest_);
    if (take_word(names) != "#" || take_word(values) != "#")
      refuse("the first two lines", "must be # with names, and # with their values, as LF_DEM writes");
    for (std::string_view name = take_word(names); !name.empty(); name = take_word(names)) {
      const auto value = number<double>(take_word(values), std::string(name));
      if (!header_.emplace(name, value).second) refuse(std::string(name), "must be there once");
    }
    if (!is_blank(values))
      refuse("the second line", "must have a value for each name of the first, and no more");
  }

  double value_of(std::string_view name) const {
    const auto found = header_.find(name);
    if (found == header_.end()) refuse(std::string(name), "must be a name in the first line");
    return found->second;
  }

  std::string_view rest_;
  std::map<std::string_view, double> header_;
};

}  // namespace

Snapshot read_lf_dem(std::string_view text, const std::string& file) {
  return LfDemReading(text, file).read();
}

}  // namespace peclet::engine
