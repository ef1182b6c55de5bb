// Frames as pictures: the meaning of colours, and refusals.
#include "engine/pictures/picture.h"

#include <gtest/gtest.h>

#include "engine/pictures/colouring.h"
#include "engine/terms/keyed_random.h"
#include "tests/contract/refusal.h"

namespace peclet::engine {
namespace {

Snapshot small_frame() {
  Snapshot snapshot;
  snapshot.lattice = {Vector3{4, 0, 0}, Vector3{1, 4, 0}, Vector3{0, 0, 4}};
  snapshot.corner = {-2.5, -2, -2};
  snapshot.position = {{0, 0, 0}, {9, 1, 0}};  // the second two cells away
  snapshot.radius = {1, 0.5};
  snapshot.species = {0, 1};
  snapshot.species_names = {"A", "B"};
  return snapshot;
}

std::string refusal(const Snapshot& snapshot, const PictureOptions& options) {
  return refusal_by([&] { picture_of(snapshot, options); });
}

TEST(Picture, HasTheSizeThatIsAskedForAndAWhiteGround) {
  PictureOptions options;
  options.size = "320x200";
  const Image image = picture_of(small_frame(), options);
  EXPECT_EQ(image.width, 320U);
  EXPECT_EQ(image.height, 200U);
  ASSERT_EQ(image.rgb.size(), 3U * 320 * 200);
  EXPECT_EQ(std::vector<std::uint8_t>(image.rgb.begin(), image.rgb.begin() + 3),
            (std::vector<std::uint8_t>{255, 255, 255}));
  // Two species give blue and red pixels; the second sphere is wrapped into the cell.
  bool is_blue = false, is_red = false;
  for (std::size_t k = 0; k < image.rgb.size(); k += 3) {
    is_blue = is_blue || image.rgb[k + 2] > image.rgb[k] + 60;
    is_red = is_red || image.rgb[k] > image.rgb[k + 2] + 60;
  }
  EXPECT_TRUE(is_blue && is_red);
}

// The flow is (2 y, 0, 0): strain 3 after a time of 1.5. The second sphere is 0.25 faster along z.
TEST(Picture, ColoursSpeedsBeyondTheFlow) {
  Snapshot snapshot = small_frame();
  snapshot.velocity = {{0, 0, 0}, {2, 0, 0.25}};
  EXPECT_EQ(colouring_of(snapshot, "speed", "").scale.front().title, "speed");
  snapshot.time = 1.5;
  snapshot.strain = 3;
  const Colouring colouring = colouring_of(snapshot, "speed", "");
  EXPECT_EQ(colouring.scale.front().title, "non-affine speed");
  EXPECT_EQ(colouring.of_spheres[0].red, viridis(0).red);
  EXPECT_EQ(colouring.scale.front().at(0.25).red, colouring.of_spheres[1].red);
}

// The flow is u = 3 (x, -y, 0); the second sphere is 0.5 faster along z.
TEST(Picture, ColoursSpeedsBeyondTheFlowThatTheFileHas) {
  Snapshot snapshot = small_frame();
  snapshot.velocity = {{0, 0, 0}, {27, -3, 0.5}};
  snapshot.velocity_gradient = Matrix3{Vector3{3, 0, 0}, Vector3{0, -3, 0}, Vector3{}};
  snapshot.time = 1;
  snapshot.strain = 3;
  const Colouring colouring = colouring_of(snapshot, "speed", "");
  EXPECT_EQ(colouring.scale.front().title, "non-affine speed");
  EXPECT_EQ(colouring.scale.front().at(0.5).red, colouring.of_spheres[1].red);
}

// Ticks closer than the rounding of their values would make an endless loop.
TEST(Picture, OfValuesThatAreAlikeButForRoundingHasAScaleWithTicks) {
  for (const double width : {0.0, 1e-16, 1e-12}) {
    const ColourScale scale = scale_over("x", {1, 1 + width, 1 + 2 * width});
    EXPECT_EQ(scale.high, 2) << width;
    EXPECT_LT(ticks_of(scale).size(), 10U);
  }
  EXPECT_EQ(scale_over("x", {1, 1 + 1e-8}).low, 1);
}

// The first would be a rod without width, the second without length; both have no colour.
TEST(Picture, OfContactsWithoutForceOrLengthHasNoRods) {
  Snapshot snapshot = small_frame();
  PictureOptions options;
  options.size = "64x64";
  options.chains = true;
  for (const double force : {0.0, 1.0}) {
    if (force > 0) snapshot.position[1] = snapshot.position[0];
    snapshot.contacts = {{0, 1, force, 0}};
    Snapshot without = snapshot;
    without.contacts->clear();
    EXPECT_EQ(picture_of(snapshot, options).rgb, picture_of(without, options).rgb);
  }
}

// A cube and the cube rotated by 90 degrees about z have one lattice.
TEST(Picture, OfATurnedCellHasTheSameSpheres) {
  Snapshot snapshot = small_frame();
  snapshot.lattice = {Vector3{4, 0, 0}, Vector3{0, 4, 0}, Vector3{0, 0, 4}};
  snapshot.corner = {-2, -2, -2};
  snapshot.contacts = {{0, 1, 1, 0}};
  Snapshot turned = snapshot;
  turned.lattice = {Vector3{0, 4, 0}, Vector3{-4, 0, 0}, Vector3{0, 0, 4}};
  turned.corner = {2, -2, -2};
  PictureOptions options;
  options.size = "64x64";
  for (const bool chains : {false, true}) {
    options.chains = chains;
    const Image a = picture_of(snapshot, options), b = picture_of(turned, options);
    std::size_t different = 0;
    for (std::size_t k = 0; k < a.rgb.size(); ++k) different += std::abs(a.rgb[k] - b.rgb[k]) > 2 ? 1 : 0;
    EXPECT_EQ(different, 0U);
  }
}

TEST(Picture, ColoursStressesOverTheVolumeOfTheSphere) {
  Snapshot snapshot = small_frame();
  snapshot.stress.resize(2);
  snapshot.stress[0].xy = 4 * 3.14159265358979 / 3 * 5;  // over 4/3 pi 1^3
  snapshot.stress[1].xy = 4 * 3.14159265358979 / 3 / 8 * 7;
  const Colouring colouring = colouring_of(snapshot, "stress", "");
  const ColourScale& scale = colouring.scale.front();
  EXPECT_EQ(colouring.of_spheres[0].green, scale.at(5).green);
  EXPECT_EQ(colouring.of_spheres[1].green, scale.at(7).green);
}

TEST(Picture, NamesSpeciesByTheirSize) {
  const Colouring colouring = colouring_of(small_frame(), "species", "");
  ASSERT_EQ(colouring.names.size(), 2U);
  EXPECT_EQ(colouring.names[1].name, "a = 0.5");
  Snapshot mixed = small_frame();
  mixed.species = {0, 0};
  EXPECT_EQ(colouring_of(mixed, "species", "").names.front().name, "A") << "of two sizes";
}

TEST(Picture, OfWhatTheFrameDoesNotHaveIsRefused) {
  PictureOptions options;
  options.file = "t.gsd";
  const auto expect = [&](const PictureOptions& asked, const std::string& reason) {
    EXPECT_TRUE(contains(refusal(small_frame(), asked), reason));
  };
  for (const auto& [colour, reason] :
       std::vector<std::pair<std::string, std::string>>{{"speed", "t.gsd: has no velocities"},
                                                        {"contacts", "t.gsd: has no numbers"},
                                                        {"stress", "has no stresses"}}) {
    options.colour = colour;
    expect(options, reason);
  }
  options.colour = "species";
  options.chains = true;
  expect(options, "\"trajectory\": {\"contacts\": true}");
  options.chains = false;
  for (const char* size :
       {"", "100", "100x", "x100", "10x100", "100x99999999999999", "-200x200", "200x200x200"}) {
    options.size = size;
    expect(options, "--size");
  }
  options.size = "100x100";
  for (const char* view : {"", "w", "10", "10,91", "nan,0", "10;10", "0,0,0"}) {
    options.view = view;
    expect(options, "--view");
  }
}

TEST(Picture, OfNamedViewsLooksAlongTheAxis) {
  for (const auto& [name, right, up] : std::vector<std::tuple<std::string, Vector3, Vector3>>{
           {"z", {1, 0, 0}, {0, 1, 0}}, {"x", {0, 0, -1}, {0, 1, 0}}, {"y", {1, 0, 0}, {0, 0, -1}}}) {
    const Stage stage{{{{0, 0, 0}, 1, {}}}, {}, {}};
    const Camera camera(stage, view_named(name), {0, 0, 100, 100});
    EXPECT_NEAR(camera.turned(right).x, 1, 1e-12) << name;
    EXPECT_NEAR(camera.turned(up).y, 1, 1e-12) << name;
  }
  EXPECT_EQ(view_named("-30,12.5").elevation, 12.5);
}

}  // namespace
}  // namespace peclet::engine
