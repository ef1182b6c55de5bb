#include "engine/pictures/picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "contract/errors.h"
#include "contract/named_files.h"
#include "contract/text.h"
#include "engine/state/periodic_cell.h"

namespace peclet::engine {
namespace {

const Colour& ink() {
  static const Colour dark = colour_of(0x333a44);
  return dark;
}

// Returns a short text: 0.3 for 0.30000000000000004.
std::string text_of(double value) { return fmt::format("{:.6g}", value); }

void draw_scale(Canvas& canvas, const Layout& layout, const ColourScale& scale) {
  const double length = 0.5 * layout.height, left = std::round(layout.legend.left),
               right = left + std::round(1.1 * layout.letters);
  const double top = std::round(0.5 * (layout.height - length)), bottom = top + std::round(length);
  for (double y = top; y < bottom; ++y) {
    const double share = (bottom - y - 0.5) / (bottom - top);
    draw_box(canvas, {left, y}, {right, y + 1}, viridis(share));
  }
  for (const double tick : ticks_of(scale)) {
    const double y = bottom - (tick - scale.low) / (scale.high - scale.low) * (bottom - top);
    draw_line(canvas, {right, y}, {right + 0.35 * layout.letters, y}, 0.09 * layout.letters, ink());
    draw_text(canvas, {right + 0.7 * layout.letters, y + 0.5 * layout.letters}, layout.letters, text_of(tick),
              ink());
  }
  draw_text(canvas, {left, top - 1.2 * layout.letters}, layout.letters, scale.title, ink());
}

void draw_names(Canvas& canvas, const Layout& layout, const std::vector<NamedColour>& names) {
  const double row = 2.2 * layout.letters;
  double y = 0.5 * (layout.height - row * static_cast<double>(names.size() - 1));
  for (const NamedColour& name : names) {
    draw_disc(canvas, {layout.legend.left + 0.7 * layout.letters, y}, 0.7 * layout.letters, name.colour);
    draw_text(canvas, {layout.legend.left + 2.1 * layout.letters, y + 0.5 * layout.letters}, layout.letters,
              name.name, ink());
    y += row;
  }
}

constexpr std::size_t least_side = 64, most_side = 10000;

// Reads two numbers with a character between them, such as "1600x1200".
template <class Number>
bool read_pair(std::string_view text, char between, Number& first, Number& second) {
  const std::size_t at = text.find(between);
  if (at == std::string_view::npos) return false;
  const auto one = number_in<Number>(text.substr(0, at)), other = number_in<Number>(text.substr(at + 1));
  if (!one || !other) return false;
  first = *one;
  second = *other;
  return true;
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

Vector3 into_cell(const Snapshot& snapshot, const CellFrame& cell, const Vector3& place) {
  const Vector3 cells = cell.fractional(place - snapshot.corner);
  return place - snapshot.lattice * Vector3{std::floor(cells.x), std::floor(cells.y), std::floor(cells.z)};
}

// Returns the vector from the first sphere to the nearest image of the second one, for spheres that touch. It
// relies on a compact cell, as sheared cells are.
Vector3 apart(const Snapshot& snapshot, const CellFrame& cell, const Vector3& from, const Vector3& to) {
  const auto& [a, b, c] = snapshot.lattice.column;
  const auto& [x, y, z] = cell.axes.column;
  Vector3 d = to - from;
  d -= std::round(dot(z, d) / cell.lengths.z) * c;
  d -= std::round(dot(y, d) / cell.lengths.y) * b;
  d -= std::round(dot(x, d) / cell.lengths.x) * a;
  return d;
}

// Adds contacts as rods and returns their scale. The cross section of a rod is proportional to its normal
// force, up to four times the mean. Contacts that leave the cell are drawn at both ends; those without force
// or length are left out.
ColourScale add_chains(const Snapshot& snapshot, const CellFrame& cell, Stage& stage) {
  std::vector<double> forces;
  double sum = 0;
  for (const SnapshotContact& contact : *snapshot.contacts) sum += contact.normal_force;
  const double mean = snapshot.contacts->empty() ? 1 : sum / static_cast<double>(snapshot.contacts->size());
  constexpr double widest = 4;
  const ColourScale scale{"force / mean", 0, widest};
  const double thickest = 0.42 * *std::ranges::min_element(snapshot.radius);
  for (const SnapshotContact& contact : *snapshot.contacts) {
    if (!(contact.normal_force > 0)) continue;
    const double force = std::min(contact.normal_force / mean, widest);
    const double thickness = thickest * std::sqrt(force / widest);
    const Vector3 &p = snapshot.position[contact.first], &q = snapshot.position[contact.second];
    const Vector3 d = apart(snapshot, cell, p, q);
    if (norm(d) < 1e-6 * thickest) continue;
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

Layout::Layout(std::size_t w, std::size_t h)
    : width(static_cast<double>(w)),
      height(static_cast<double>(h)),
      margin(0.03 * height),
      letters(0.0195 * height) {
  const double side = std::min(14 * letters, 0.3 * width);
  spheres = {margin, margin, width - margin - side, height - margin};
  legend = {width - side, margin, width - margin, height - margin};
}

void draw_legend(Canvas& canvas, const Layout& layout, const Colouring& colouring) {
  for (const ColourScale& scale : colouring.scale) draw_scale(canvas, layout, scale);
  if (!colouring.names.empty()) draw_names(canvas, layout, colouring.names);
}

void draw_axes(Canvas& canvas, const Layout& layout, const Camera& camera, const std::string& text) {
  const double length = 3 * layout.letters;
  const Spot origin = {layout.legend.left + 1.5 * layout.letters,
                       layout.height - layout.margin - 1.5 * layout.letters};
  const std::array<std::pair<const char*, Vector3>, 3> axes = {
      {{"x", {1, 0, 0}}, {"y", {0, 1, 0}}, {"z", {0, 0, 1}}}};
  for (const auto& [name, direction] : axes) {
    const Vector3 seen = camera.turned(direction);
    const double size = std::hypot(seen.x, seen.y);
    if (size < 0.1) continue;  // along the line of sight
    const Spot end = {origin.x + length * seen.x, origin.y - length * seen.y};
    draw_line(canvas, origin, end, 0.12 * layout.letters, ink());
    const double beyond = 1 + 0.3 / size;
    const double half = 0.5 * width_of_text(name, layout.letters);
    draw_text(canvas,
              {origin.x + beyond * length * seen.x - half,
               origin.y - beyond * length * seen.y + 0.4 * layout.letters},
              layout.letters, name, ink());
  }
  draw_text(canvas, {layout.legend.left, layout.margin + layout.letters}, layout.letters, text, ink());
}

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

Image picture_of(const Snapshot& given, const PictureOptions& options, const FilmFraming* film) {
  const auto [width, height] = size_named(options.size);
  const View view = view_named(options.view);
  Snapshot snapshot = given;
  Colouring colouring = colouring_of(snapshot, options.colour, options.file,
                                     film != nullptr ? film->scale : std::vector<ColourScale>{});
  const CellFrame cell = PeriodicCell::with_edges(snapshot.lattice, Matrix3{}).frame();
  for (Vector3& place : snapshot.position) place = into_cell(snapshot, cell, place);
  Stage stage;
  if (options.chains) {
    if (!snapshot.contacts) {
      throw InputError(
          options.file, "", "",
          "has no contacts, which --chains needs: set \"trajectory\": {\"contacts\": true} in the scene");
    }
    colouring = {{}, {add_chains(snapshot, cell, stage)}, {}};
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
  const Camera camera(film != nullptr ? film->bounds : stage, view, layout.spheres);
  render(canvas, stage, camera, options.threads);
  draw_legend(canvas, layout, colouring);
  draw_axes(canvas, layout, camera, snapshot.strain ? fmt::format("strain {:.2f}", *snapshot.strain) : "");
  return canvas.image();
}

std::string draw_picture(const PictureOptions& options) {
  size_named(options.size);
  view_named(options.view);
  check_output(options.output);
  const SnapshotFile file(options.file);
  const Snapshot snapshot = file.read(file.index_of(options.frame));
  write_output(options.output, png(picture_of(snapshot, options)));
  return snapshot.has_sizes ? "" : note_on_sizes(options.file);
}

}  // namespace peclet::engine
