#include "engine/pictures/picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "contract/input_error.h"
#include "contract/output_file.h"
#include "engine/pictures/colouring.h"
#include "engine/pictures/legend.h"
#include "engine/pictures/renderer.h"
#include "engine/snapshots/snapshot_file.h"

namespace peclet::engine {
namespace {

constexpr std::size_t least_side = 64, most_side = 10000;

// Reads "1600x1200": two numbers and what stands between them.
template <class Number>
bool read_pair(std::string_view text, char between, Number& first, Number& second) {
  const std::size_t at = text.find(between);
  if (at == std::string_view::npos) return false;
  const auto read = [](std::string_view part, Number& value) {
    const auto done = std::from_chars(part.data(), part.data() + part.size(), value);
    return done.ec == std::errc() && done.ptr == part.data() + part.size();
  };
  return read(text.substr(0, at), first) && read(text.substr(at + 1), second);
}

std::pair<std::size_t, std::size_t> size_named(const std::string& name) {
  std::size_t width = 0, height = 0;
  const bool is_good = read_pair(name, 'x', width, height) && std::min(width, height) >= least_side &&
                       std::max(width, height) <= most_side;
  if (is_good) return {width, height};
  throw InputError("--size", "", name,
                   fmt::format("must be WIDTHxHEIGHT, each {} to {} pixels", least_side, most_side));
}

void add_cell(const Snapshot& snapshot, double thickness, Stage& stage) {
  const Colour grey = colour_of(0x5b6470);
  for (std::size_t along = 0; along < 3; ++along) {
    const Vector3 &edge = snapshot.lattice.column[along], &one = snapshot.lattice.column[(along + 1) % 3],
                  &other = snapshot.lattice.column[(along + 2) % 3];
    for (const Vector3& from : {Vector3{}, one, other, one + other}) {
      stage.rods.push_back({snapshot.corner + from, snapshot.corner + from + edge, thickness, grey});
    }
  }
}

Vector3 into_cell(const Snapshot& snapshot, const Vector3& place) {
  const auto& [a, b, c] = snapshot.lattice.column;
  const Vector3 from_corner = place - snapshot.corner;
  const double z = from_corner.z / c.z, y = (from_corner.y - c.y * z) / b.y,
               x = (from_corner.x - c.x * z - b.x * y) / a.x;
  return place - snapshot.lattice * Vector3{std::floor(x), std::floor(y), std::floor(z)};
}

// From the first sphere to the nearest image of the second. A sheared cell is compact: one of the images that
// are next to each other in fractions is the nearest of spheres that touch.
Vector3 apart(const Snapshot& snapshot, const Vector3& from, const Vector3& to) {
  const auto& [a, b, c] = snapshot.lattice.column;
  Vector3 d = to - from;
  d -= std::round(d.z / c.z) * c;
  d -= std::round(d.y / b.y) * b;
  d -= std::round(d.x / a.x) * a;
  return d;
}

// Contacts as rods, as wide as their normal force, up to four times its mean. One that leaves the cell is
// drawn at both of its ends.
ColourScale add_chains(const Snapshot& snapshot, Stage& stage) {
  std::vector<double> forces;
  double sum = 0;
  for (const SnapshotContact& contact : *snapshot.contacts) sum += contact.normal_force;
  const double mean = snapshot.contacts->empty() ? 1 : sum / static_cast<double>(snapshot.contacts->size());
  constexpr double widest = 4;
  const ColourScale scale{"force / mean", 0, widest};
  const double thickest = 0.42 * *std::ranges::min_element(snapshot.radius);
  for (const SnapshotContact& contact : *snapshot.contacts) {
    const double force = std::min(contact.normal_force / mean, widest);
    const double thickness = thickest * std::sqrt(force / widest);
    const Vector3 &p = snapshot.position[contact.first], &q = snapshot.position[contact.second];
    const Vector3 d = apart(snapshot, p, q);
    const Colour colour = scale.at(force);
    const bool stays = norm(p + d - q) < 1e-6 * norm(d);
    if (stays) {
      stage.rods.push_back({p, q, thickness, colour});
    } else {
      stage.rods.push_back({p, p + 0.5 * d, thickness, colour});
      stage.rods.push_back({q, q - 0.5 * d, thickness, colour});
    }
  }
  return scale;
}

}  // namespace

View view_named(const std::string& name) {
  if (name == "corner") return {24, 18};
  if (name == "x") return {90, 0};
  if (name == "y") return {0, 90};
  if (name == "z") return {0, 0};
  View view{};
  const bool is_good = read_pair(name, ',', view.azimuth, view.elevation) && std::abs(view.azimuth) <= 360 &&
                       std::abs(view.elevation) <= 90;
  if (is_good) return view;
  throw InputError(
      "--view", "", name,
      "must be corner, x, y, z, or AZIMUTH,ELEVATION in degrees, up to 360 and 90 on both sides");
}

Image picture_of(const Snapshot& given, const PictureOptions& options) {
  const auto [width, height] = size_named(options.size);
  const View view = view_named(options.view);
  Snapshot snapshot = given;
  for (Vector3& place : snapshot.position) place = into_cell(snapshot, place);
  Stage stage;
  Colouring colouring = colouring_of(snapshot, options.colour, options.file);
  if (options.chains) {
    if (!snapshot.contacts) {
      throw InputError(
          options.file, "", "",
          "has no contacts, which --chains asks for: \"trajectory\": {\"contacts\": true} leaves them");
    }
    colouring = {{}, {add_chains(snapshot, stage)}, {}};
    for (std::size_t i = 0; i < snapshot.count(); ++i) {
      stage.glass.push_back({snapshot.position[i], snapshot.radius[i], {}});
    }
  } else {
    for (std::size_t i = 0; i < snapshot.count(); ++i) {
      stage.balls.push_back({snapshot.position[i], snapshot.radius[i], colouring.of_spheres[i]});
    }
  }
  add_cell(snapshot, 0.0016 * norm(snapshot.lattice * Vector3{1, 1, 1}), stage);
  Canvas canvas(width, height);
  const Layout layout(width, height);
  const Camera camera(stage, view, layout.spheres);
  render(canvas, stage, camera, options.threads);
  draw_legend(canvas, layout, colouring);
  draw_axes(canvas, layout, camera, snapshot.strain ? fmt::format("strain {:.2f}", *snapshot.strain) : "");
  return canvas.image();
}

void draw_picture(const PictureOptions& options) {
  size_named(options.size);
  view_named(options.view);
  check_output(options.output);
  const SnapshotFile file(options.file);
  write_output(options.output, png(picture_of(file.read(file.index_of(options.frame)), options)));
}

}  // namespace peclet::engine
