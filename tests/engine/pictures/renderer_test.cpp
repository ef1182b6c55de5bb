// The camera's view, compared with the geometry of spheres.
#include "engine/pictures/renderer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace peclet::engine {
namespace {

const Colour red = colour_of(0xff0000), blue = colour_of(0x0000ff);
constexpr Frame whole{0, 0, 400, 400};

Canvas drawn(const Stage& stage, const View& view, int threads = 1) {
  Canvas canvas(400, 400);
  render(canvas, stage, Camera(stage, view, whole), threads);
  return canvas;
}

bool is_white(const Colour& c) { return c.red == 1 && c.green == 1 && c.blue == 1; }

// Returns the share of pixels that are not white, those of edges included.
double covered(const Canvas& canvas) {
  double share = 0;
  for (const Colour& c : canvas.pixel) share += is_white(c) ? 0 : 1;
  return share / static_cast<double>(canvas.pixel.size());
}

// A ball that fills the frame covers pi/4 of it; half of its edge pixels count as covered.
TEST(PictureOfABall, IsADiscThatFillsTheFrame) {
  const Stage stage{{{{3, -2, 7}, 2, red}}, {}, {}};
  for (const View& view : {View{0, 0}, View{24, 18}, View{-100, -80}}) {
    const Canvas canvas = drawn(stage, view);
    EXPECT_NEAR(covered(canvas), std::numbers::pi / 4, 0.005);
    EXPECT_TRUE(is_white(canvas.pixel[0]));
    const Colour middle = canvas.pixel[200 * 400 + 200];
    EXPECT_GT(middle.red, 0.4);
    EXPECT_LT(middle.green, 0.1);
  }
}

// In a view along z the eye is at z > 0, with x to the right and y up.
TEST(PictureOfBalls, ShowsTheNearerOneAndTheRightSideUp) {
  const Stage stage{{{{0, 0, 0}, 1, red}, {{0, 0, 3}, 0.5, blue}, {{0, 2, 0}, 0.5, blue}}, {}, {}};
  const Camera camera(stage, {0, 0}, whole);
  const Canvas canvas = drawn(stage, {0, 0});
  const auto at = [&](const Vector3& place) {
    const Vector3 seen = camera.seen(place);
    return canvas.pixel[static_cast<std::size_t>(camera.top() - camera.scale() * seen.y / seen.z) * 400 +
                        static_cast<std::size_t>(camera.left() + camera.scale() * seen.x / seen.z)];
  };
  EXPECT_GT(at({0, 0, 3.5}).blue, at({0, 0, 3.5}).red) << "before the red one";
  EXPECT_GT(at({0.8, 0, 0.6}).red, at({0.8, 0, 0.6}).blue);
  EXPECT_GT(at({0, 2, 0.5}).blue, at({0, 2, 0.5}).red);
  EXPECT_LT(camera.top() - camera.scale() * camera.seen({0, 2, 0}).y / camera.seen({0, 2, 0}).z, 200) << "up";
  const Vector3 right = camera.turned({1, 0, 0});
  EXPECT_GT(right.x, 0);
  EXPECT_NEAR(right.y, 0, 1e-12);
}

TEST(PictureOfBalls, IsTheSameFromAnyNumberOfThreads) {
  Stage stage;
  for (int k = 0; k < 30; ++k)
    stage.balls.push_back({{std::sin(7.0 * k), std::cos(3.0 * k), 0.1 * k}, 0.3, red});
  stage.rods.push_back({{-1, -1, -1}, {1, 1, 1}, 0.05, blue});
  stage.glass.push_back({{0, 0, 2}, 1, {}});
  const Canvas one = drawn(stage, {20, 20}, 1), three = drawn(stage, {20, 20}, 3);
  for (std::size_t k = 0; k < one.pixel.size(); ++k) {
    ASSERT_TRUE(one.pixel[k].red == three.pixel[k].red && one.pixel[k].blue == three.pixel[k].blue);
  }
}

// A rod of length 4 and radius 1/2 across the view is a strip with round ends. Perspective enlarges the near
// side by less than a hundredth.
TEST(PictureOfARod, CoversAStripInEveryDirection) {
  const double share = (4 * 1 + std::numbers::pi / 4) / (5.0 * 5.0);
  for (const double angle : {0.0, 0.3, 1.2, std::numbers::pi / 2, 2.5}) {
    const Vector3 half{2 * std::cos(angle), 2 * std::sin(angle), 0};
    const Stage stage{{}, {{-half, half, 0.5, red}}, {}};
    const Canvas canvas = drawn(stage, {0, 0});
    // The longer side fits the frame.
    const double side = 1 + 4 * std::max(std::abs(std::cos(angle)), std::abs(std::sin(angle)));
    EXPECT_NEAR(covered(canvas), share * 25 / (side * side), 0.02 * share * 25 / (side * side)) << angle;
  }
}

// A ball of radius a at distance r, wholly above the horizon at angle t, occludes (a/r)^2 cos t.
TEST(Occlusion, OfOneBallIsTheSolidAngleWithTheCosine) {
  const std::vector<Ball> balls = {{{0, 0, 0}, 1, red}, {{0, 3, 0}, 1, red}};
  const Occlusion sky(balls);
  EXPECT_NEAR(sky.free_sky(0, {0, 1, 0}, {0, 1, 0}), 1 - 1.0 / 4, 1e-12);
  EXPECT_NEAR(sky.free_sky(0, {0, -1, 0}, {0, -1, 0}), 1, 1e-12);
  const Vector3 apart = Vector3{0, 3, 0} - Vector3{std::sqrt(0.5), std::sqrt(0.5), 0};
  const double square = dot(apart, apart), cosine = (apart.x + apart.y) * std::sqrt(0.5) / std::sqrt(square);
  const Vector3 slanted{std::sqrt(0.5), std::sqrt(0.5), 0};
  EXPECT_NEAR(sky.free_sky(0, slanted, slanted), 1 - cosine / square, 1e-12);
  const Occlusion alone({{{0, 0, 0}, 1, red}, {{0, 9, 0}, 1, red}});
  EXPECT_EQ(alone.free_sky(0, {0, 1, 0}, {0, 1, 0}), 1) << "farther than it is looked for";
}

}  // namespace
}  // namespace peclet::engine
