#include "engine/pictures/renderer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "engine/state/threads.h"

namespace peclet::engine {
namespace {

// Calls visit(centre, radius) for balls that enclose the stage: its balls and both ends of its rods.
template <class Visit>
void for_each_bound(const Stage& stage, const Visit& visit) {
  for (const Ball& ball : stage.balls) visit(ball.centre, ball.radius);
  for (const Ball& ball : stage.glass) visit(ball.centre, ball.radius);
  for (const Rod& rod : stage.rods) {
    visit(rod.from, rod.radius);
    visit(rod.to, rod.radius);
  }
}

// The gap over the larger radius beyond which a neighbour's cap is too small to be seen.
constexpr double listed_within = 1.2;

using Box = std::array<std::int64_t, 3>;

// The light on surfaces: a bright sky, a lamp at the upper left, and haze that grows with the distance.
class Light {
 public:
  // `seen` is the stage in the coordinates of the camera.
  Light(const Camera& camera, const Stage& seen) : glass_(colour_of(0x8fa3b8)) {
    constexpr Vector3 towards_lamp = {-0.45, 0.75, -0.6};  // over the eye's left shoulder
    lamp_ = (1 / norm(towards_lamp)) * towards_lamp;
    up_ = camera.turned({0, 1, 0});
    double near = std::numeric_limits<double>::infinity(), far = -near;
    const auto take = [&](double z) {
      near = std::min(near, z);
      far = std::max(far, z);
    };
    for (const Ball& ball : seen.balls) take(ball.centre.z);
    for (const Ball& ball : seen.glass) take(ball.centre.z);
    near_ = near;
    depth_ = std::max(far - near, std::numeric_limits<double>::min());
  }

  // Returns the light that reaches the eye from a place with this normal and this free share of the sky.
  Colour on(const Colour& surface, const Vector3& place, const Vector3& normal, double free_sky) const {
    const Vector3 to_eye = (-1 / norm(place)) * place;
    const double facing = std::max(0.0, dot(normal, to_eye));
    const double sky = (0.50 + 0.28 * dot(normal, up_)) * free_sky;
    // The lamp is wide: it reaches around the edge, and gaps between spheres are in its shade, too.
    const double lamp = std::max(0.0, (dot(normal, lamp_) + 0.25) / 1.25) * (0.25 + 0.75 * free_sky);
    const Vector3 half = lamp_ + to_eye;
    const double gloss = std::pow(std::max(0.0, dot(normal, half) / norm(half)), 60) * 0.16 * free_sky;
    const double rim = 0.72 + 0.28 * std::sqrt(facing);
    Colour colour = static_cast<float>((sky + 0.62 * lamp) * rim) * surface;
    colour = colour + static_cast<float>(gloss) * white;
    const double air = 0.34 * std::clamp((place.z - near_) / depth_, 0.0, 1.0);
    return mixed(colour, white, static_cast<float>(air));
  }

  // Return the colour of glass, and the share of the light behind that it takes, by the cosine of ray and
  // surface: more towards the rim.
  const Colour& glass() const { return glass_; }
  static double veil(double cosine) {
    const double rim = 1 - cosine;
    return 0.008 + 0.30 * rim * rim * rim * rim;
  }

 private:
  Vector3 lamp_, up_;
  double near_ = 0, depth_ = 1;
  Colour glass_;
};

constexpr std::size_t rays = 3;           // along each side of a pixel
constexpr std::size_t rows_of_band = 16;  // rows of pixels whose rays stay in the cache

constexpr float nothing = std::numeric_limits<float>::infinity();
constexpr std::uint32_t background = 0xffffffff;

// The depth and the number of the object, balls before rods, that each ray of some rows of pixels sees.
class Band {
 public:
  Band(const Camera& camera, std::size_t width, std::size_t first_row, std::size_t rows)
      : width_(width * rays),
        rows_(rows * rays),
        first_(first_row * rays),
        pixel_(1 / (camera.scale() * rays)),
        u0_(-camera.left() / camera.scale()),
        v0_(camera.top() / camera.scale()),
        depth_(width_ * rows_, nothing),
        object_(width_ * rows_, background),
        through_(width_ * rows_, 1) {}

  double u(std::size_t x) const { return u0_ + (static_cast<double>(x) + 0.5) * pixel_; }
  double v(std::size_t y) const { return v0_ - (static_cast<double>(first_ + y) + 0.5) * pixel_; }

  // Calls visit(place, u) for each ray of a row with u in [low, high].
  template <class Visit>
  void for_each_ray(std::size_t y, double low, double high, const Visit& visit) const {
    const std::size_t begin = bounded((low - u0_) / pixel_ - 0.5, width_),
                      end = bounded((high - u0_) / pixel_ + 0.5, width_);
    for (std::size_t x = begin; x < end; ++x) visit(y * width_ + x, u(x));
  }
  // Returns the rows with v in [low, high].
  std::pair<std::size_t, std::size_t> rows_within(double low, double high) const {
    const double first = static_cast<double>(first_);
    return {bounded((v0_ - high) / pixel_ - first - 0.5, rows_),
            bounded((v0_ - low) / pixel_ - first + 0.5, rows_)};
  }

  void put(std::size_t place, float depth, std::uint32_t object) {
    if (depth >= depth_[place]) return;
    depth_[place] = depth;
    object_[place] = object;
  }
  void veil(std::size_t place, float depth, float share) {
    if (depth < depth_[place]) through_[place] *= 1 - share;
  }

  // Calls visit(depth, object, through, u, v) for the rays of a pixel.
  template <class Visit>
  void for_each_ray_of_pixel(std::size_t x, std::size_t y, const Visit& visit) const {
    for (std::size_t row = rays * y; row < rays * (y + 1); ++row) {
      for (std::size_t column = rays * x; column < rays * (x + 1); ++column) {
        const std::size_t place = row * width_ + column;
        visit(depth_[place], object_[place], through_[place], u(column), v(row));
      }
    }
  }

 private:
  static std::size_t bounded(double x, std::size_t count) {
    return static_cast<std::size_t>(std::clamp(std::ceil(x), 0.0, static_cast<double>(count)));
  }

  std::size_t width_, rows_, first_;
  double pixel_, u0_, v0_;
  std::vector<float> depth_;
  std::vector<std::uint32_t> object_;
  std::vector<float> through_;  // share of the light that the glass in front lets pass
};

// Calls hit(place, depth, cosine of ray and surface) where rays (u, v, 1) first meet the ball.
template <class Hit>
void trace(Band& band, const Ball& ball, const Hit& hit) {
  const Vector3& c = ball.centre;
  const Reach reach = reach_of(c, ball.radius);
  const double outside = dot(c, c) - ball.radius * ball.radius;
  const auto [begin, end] = band.rows_within(reach.low_v, reach.high_v);
  for (std::size_t y = begin; y < end; ++y) {
    const double v = band.v(y), along = c.y * v + c.z, length = 1 + v * v;
    band.for_each_ray(y, reach.low_u, reach.high_u, [&](std::size_t place, double u) {
      const double a = length + u * u, b = along + c.x * u, square = b * b - a * outside;
      if (square <= 0) return;
      const double root = std::sqrt(square);
      hit(place, static_cast<float>((b - root) / a), root / (std::sqrt(a) * ball.radius));
    });
  }
}

// Puts a rod into the band. A ray (u, v, 1) t meets the cylinder about p + s q, 0 < s < 1, where its distance
// from the axis is the radius, or one of the ends.
void trace(Band& band, const Rod& rod, std::uint32_t number) {
  const Vector3 &p = rod.from, q = rod.to - rod.from;
  const double square = rod.radius * rod.radius, qq = dot(q, q), qp = -dot(q, p), pp = dot(p, p);
  const Reach a = reach_of(rod.from, rod.radius), b = reach_of(rod.to, rod.radius);
  // A row crosses the rod around the point where it crosses the axis, within the width of the rod.
  const double from_u = p.x / p.z, from_v = p.y / p.z, to_u = rod.to.x / rod.to.z, to_v = rod.to.y / rod.to.z;
  const double slope = std::abs(to_v - from_v) > 0 ? (to_u - from_u) / (to_v - from_v) : 0;
  const double half =
      std::max({a.high_u - a.low_u, b.high_u - b.low_u, a.high_v - a.low_v, b.high_v - b.low_v}) / 2;
  const double side = half * std::sqrt(1 + slope * slope), low = std::min(a.low_u, b.low_u),
               high = std::max(a.high_u, b.high_u);
  const auto [begin, end] = band.rows_within(std::min(a.low_v, b.low_v), std::max(a.high_v, b.high_v));
  for (std::size_t y = begin; y < end; ++y) {
    const double v = band.v(y), middle = from_u + slope * (v - from_v);
    const bool is_level = std::abs(to_v - from_v) < 4 * half;
    band.for_each_ray(
        y, is_level ? low : std::max(low, middle - side), is_level ? high : std::min(high, middle + side),
        [&](std::size_t place, double u) {
          const double dd = u * u + v * v + 1, qd = q.x * u + q.y * v + q.z, dp = -(p.x * u + p.y * v + p.z);
          const double aa = qq * dd - qd * qd, bb = qq * dp - qp * qd, cc = qq * pp - qp * qp - square * qq;
          const double root = bb * bb - aa * cc;
          if (root < 0) return;
          const double t = (-bb - std::sqrt(root)) / aa, s = qp + t * qd;
          if (s > 0 && s < qq) return band.put(place, static_cast<float>(t), number);
          const Vector3& c = s <= 0 ? rod.from : rod.to;
          const double of_end = c.x * u + c.y * v + c.z, under = of_end * of_end - dd * (dot(c, c) - square);
          if (under > 0) band.put(place, static_cast<float>((of_end - std::sqrt(under)) / dd), number);
        });
  }
}

class Rendering {
 public:
  Rendering(Canvas& canvas, const Stage& stage, const Camera& camera)
      : canvas_(canvas),
        camera_(camera),
        stage_(camera.seen(stage)),
        sky_(stage_.balls),
        light_(camera, stage_) {}

  void draw(std::size_t first_row, std::size_t rows) const {
    Band band(camera_, canvas_.width, first_row, rows);
    const auto balls = static_cast<std::uint32_t>(stage_.balls.size());
    for (std::uint32_t i = 0; i < balls; ++i) {
      trace(band, stage_.balls[i],
            [&](std::size_t place, float depth, double) { band.put(place, depth, i); });
    }
    for (std::uint32_t k = 0; k < stage_.rods.size(); ++k) trace(band, stage_.rods[k], balls + k);
    for (const Ball& ball : stage_.glass) {
      trace(band, ball, [&](std::size_t place, float depth, double cosine) {
        band.veil(place, depth, static_cast<float>(Light::veil(cosine)));
      });
    }
    for (std::size_t y = 0; y < rows; ++y) {
      for (std::size_t x = 0; x < canvas_.width; ++x) {
        Colour& pixel = canvas_.at(x, first_row + y);
        pixel = colour_of_pixel(band, x, y, pixel);
      }
    }
  }

 private:
  // Computes the light of each object in a pixel once, where the first of the pixel's rays meets it.
  Colour colour_of_pixel(const Band& band, std::size_t x, std::size_t y, const Colour& behind) const {
    struct Seen {
      std::uint32_t object;
      Colour colour;
    };
    std::array<Seen, rays * rays> known;
    std::size_t count = 0;
    Colour sum;
    band.for_each_ray_of_pixel(
        x, y, [&](float depth, std::uint32_t object, float through, double u, double v) {
          const auto end = known.begin() + static_cast<std::ptrdiff_t>(count);
          auto found =
              std::find_if(known.begin(), end, [&](const Seen& one) { return one.object == object; });
          if (found == end) {
            const Vector3 place = {u * double{depth}, v * double{depth}, double{depth}};
            *found = {object, object == background ? behind : colour_at(object, place)};
            ++count;
          }
          sum = sum + mixed(light_.glass(), found->colour, through);
        });
    return (1.0F / (rays * rays)) * sum;
  }

  Colour colour_at(std::uint32_t object, const Vector3& place) const {
    if (object < stage_.balls.size()) {
      const Ball& ball = stage_.balls[object];
      const Vector3 normal = (1 / ball.radius) * (place - ball.centre);
      return light_.on(ball.colour, place, normal, sky_.free_sky(object, place, normal));
    }
    const Rod& rod = stage_.rods[object - stage_.balls.size()];
    const Vector3 axis = rod.to - rod.from;
    const double along = std::clamp(dot(place - rod.from, axis) / dot(axis, axis), 0.0, 1.0);
    const Vector3 normal = (1 / rod.radius) * (place - rod.from - along * axis);
    return light_.on(rod.colour, place, normal, 1);
  }

  Canvas& canvas_;
  const Camera& camera_;
  Stage stage_;  // in the coordinates of the camera
  Occlusion sky_;
  Light light_;
};

}  // namespace

Camera::Camera(const Stage& stage, const View& view, const Frame& frame) {
  constexpr double degree = std::numbers::pi / 180, distance = 6;
  const double a = view.azimuth * degree, e = view.elevation * degree;
  const Vector3 towards_eye = {std::cos(e) * std::sin(a), std::sin(e), std::cos(e) * std::cos(a)};
  forward_ = -towards_eye;
  right_ = {std::cos(a), 0, -std::sin(a)};
  up_ = cross(right_, forward_);
  constexpr double far = std::numeric_limits<double>::infinity();
  Vector3 low = {far, far, far}, high = {-far, -far, -far};
  for_each_bound(stage, [&](const Vector3& c, double r) {
    low = {std::min(low.x, c.x - r), std::min(low.y, c.y - r), std::min(low.z, c.z - r)};
    high = {std::max(high.x, c.x + r), std::max(high.y, c.y + r), std::max(high.z, c.z + r)};
  });
  eye_ = 0.5 * (low + high) + (distance * 0.5 * norm(high - low)) * towards_eye;
  Reach all{far, -far, far, -far};
  for_each_bound(stage, [&](const Vector3& c, double r) {
    const Reach one = reach_of(seen(c), r);
    all = {std::min(all.low_u, one.low_u), std::max(all.high_u, one.high_u), std::min(all.low_v, one.low_v),
           std::max(all.high_v, one.high_v)};
  });
  scale_ = std::min((frame.right - frame.left) / (all.high_u - all.low_u),
                    (frame.bottom - frame.top) / (all.high_v - all.low_v));
  left_ = 0.5 * (frame.left + frame.right) - scale_ * 0.5 * (all.low_u + all.high_u);
  top_ = 0.5 * (frame.top + frame.bottom) + scale_ * 0.5 * (all.low_v + all.high_v);
}

Vector3 Camera::turned(const Vector3& d) const { return {dot(right_, d), dot(up_, d), dot(forward_, d)}; }
Vector3 Camera::seen(const Vector3& place) const { return turned(place - eye_); }

Stage Camera::seen(const Stage& stage) const {
  Stage all = stage;
  for (Ball& ball : all.balls) ball.centre = seen(ball.centre);
  for (Ball& ball : all.glass) ball.centre = seen(ball.centre);
  for (Rod& rod : all.rods) {
    rod.from = seen(rod.from);
    rod.to = seen(rod.to);
  }
  return all;
}

// Tangents from the eye: (c_x c_z -+ r sqrt(c_x^2 + c_z^2 - r^2)) / (c_z^2 - r^2).
Reach reach_of(const Vector3& c, double r) {
  const double below = c.z * c.z - r * r;
  const double u = r * std::sqrt(c.x * c.x + below), v = r * std::sqrt(c.y * c.y + below);
  return {(c.x * c.z - u) / below, (c.x * c.z + u) / below, (c.y * c.z - v) / below, (c.y * c.z + v) / below};
}

Occlusion::Occlusion(const std::vector<Ball>& balls) {
  double largest = 0;
  for (const Ball& ball : balls) largest = std::max(largest, ball.radius);
  const double edge = (2 + listed_within) * largest;
  const auto box_of = [edge](const Vector3& c) {
    const auto part = [edge](double x) { return static_cast<std::int64_t>(std::floor(x / edge)); };
    return Box{part(c.x), part(c.y), part(c.z)};
  };
  std::map<Box, std::vector<std::uint32_t>> boxes;
  for (std::uint32_t i = 0; i < balls.size(); ++i) boxes[box_of(balls[i].centre)].push_back(i);
  for (std::uint32_t i = 0; i < balls.size(); ++i) {
    begin_.push_back(static_cast<std::uint32_t>(neighbours_.size()));
    const Ball& ball = balls[i];
    const Box middle = box_of(ball.centre);
    for (int place = 0; place < 27; ++place) {
      const auto found =
          boxes.find({middle[0] + place % 3 - 1, middle[1] + place / 3 % 3 - 1, middle[2] + place / 9 - 1});
      if (found == boxes.end()) continue;
      for (const std::uint32_t j : found->second) {
        const double gap = norm(balls[j].centre - ball.centre) - ball.radius - balls[j].radius;
        if (j == i || gap > listed_within * std::max(ball.radius, balls[j].radius)) continue;
        neighbours_.push_back({balls[j].centre, balls[j].radius * balls[j].radius});
      }
    }
  }
  begin_.push_back(static_cast<std::uint32_t>(neighbours_.size()));
}

double Occlusion::free_sky(std::uint32_t ball, const Vector3& place, const Vector3& normal) const {
  double free = 1;
  for (std::uint32_t k = begin_[ball]; k < begin_[ball + 1]; ++k) {
    const Vector3 apart = neighbours_[k].centre - place;
    const double square = dot(apart, apart), cap = neighbours_[k].square / square;
    const double cosine = dot(normal, apart) / std::sqrt(square);
    // If the horizon cuts the cap, between +-sine, a parabola joins the full cap to 0.
    const double sine = std::sqrt(std::min(cap, 1.0));
    const double seen = cosine >= sine    ? cosine
                        : cosine <= -sine ? 0
                                          : (cosine + sine) * (cosine + sine) / (4 * sine);
    free *= 1 - std::min(1.0, seen * cap);
  }
  return free;
}

void render(Canvas& canvas, const Stage& stage, const Camera& camera, int threads) {
  const Rendering rendering(canvas, stage, camera);
  const std::size_t bands = (canvas.height + rows_of_band - 1) / rows_of_band;
  for_each_index(bands, threads, [&](std::size_t band) {
    const std::size_t first = band * rows_of_band;
    rendering.draw(first, std::min(rows_of_band, canvas.height - first));
  });
}

}  // namespace peclet::engine
