// Pictures show the modules where the posture has them, and taking them leaves the physics alone.
#include "hal/sim/camera.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "tests/hal/sim/worlds.hpp"

namespace eciton::hal::sim {
namespace {

const CameraConfig small{.width = 320, .height = 160};

/// Level, joints straight, rotors upright, side by side along x.
std::vector<double> posture(std::initializer_list<robot::Vector3> places) {
  std::vector<double> out;
  for (const robot::Vector3& p : places) {
    const double one[15] = {p.x(), p.y(), p.z(), 1};
    out.insert(out.end(), one, one + 15);
  }
  return out;
}

View view_of(const Camera& camera, const std::vector<double>& of) { return camera.framing(std::span(&of, 1)); }

/// Mean place of the pixels in which one channel stands out: blue is the first module, orange the second.
struct Blob {
  double x = 0, y = 0;
  int pixels = 0;
  bool at_the_edge = false;
};

Blob find(const Picture& picture, bool blue) {
  Blob blob;
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      const std::uint8_t* p = &picture.rgb[3 * static_cast<std::size_t>(y * picture.width + x)];
      if (blue ? p[2] < p[0] + 70 : p[0] < p[2] + 70) continue;
      blob.x += x;
      blob.y += y;
      ++blob.pixels;
      blob.at_the_edge |= x == 0 || y == 0 || x == picture.width - 1 || y == picture.height - 1;
    }
  }
  blob.x /= blob.pixels;
  blob.y /= blob.pixels;
  return blob;
}

class CameraTest : public ::testing::Test {
 protected:
  /// One for all tests: opening it takes longer than a picture.
  static void SetUpTestSuite() {
    Result<Camera> opened = Camera::open(robot::legion(), 2, small);
    if (opened) camera_ = std::make_unique<Camera>(std::move(opened).value());
  }
  static void TearDownTestSuite() { camera_.reset(); }
  void SetUp() override {
    if (camera_ == nullptr) GTEST_SKIP() << "there is no EGL to take pictures with";
  }
  Picture take(const std::vector<double>& of, const View& view) {
    Result<Picture> picture = camera_->take(of, view);
    EXPECT_TRUE(picture.ok());
    return picture ? *picture : Picture{1, 1, {0, 0, 0}};
  }

  inline static std::unique_ptr<Camera> camera_;
};

TEST_F(CameraTest, ShowsEveryModuleWhereItIs) {
  const auto apart = posture({{0, 0, 1.5}, {-1.5, 0, 1.5}});
  const Picture picture = take(apart, view_of(*camera_, apart));
  ASSERT_EQ(picture.rgb.size(), 3u * 320 * 160);
  const Blob blue = find(picture, true), orange = find(picture, false);
  EXPECT_GT(blue.pixels, 50);
  EXPECT_GT(orange.pixels, 50);
  EXPECT_FALSE(blue.at_the_edge || orange.at_the_edge);
  EXPECT_GT(blue.x, orange.x + 60);  // seen from the side: x to the right

  const Picture exchanged = take(posture({{-1.5, 0, 1.5}, {0, 0, 1.5}}), view_of(*camera_, apart));
  EXPECT_LT(find(exchanged, true).x, find(exchanged, false).x - 60);
  const Picture higher = take(posture({{0, 0, 1.8}, {-1.5, 0, 1.5}}), view_of(*camera_, apart));
  EXPECT_LT(find(higher, true).y, blue.y - 10);  // rows count from the top
}

TEST_F(CameraTest, FramesAWideFleetToo) {
  const auto wide = posture({{0, 0, 1}, {-6, 2, 3}});
  const Picture picture = take(wide, view_of(*camera_, wide));
  const Blob blue = find(picture, true), orange = find(picture, false);
  EXPECT_GT(blue.pixels, 5);
  EXPECT_GT(orange.pixels, 5);
  EXPECT_FALSE(blue.at_the_edge || orange.at_the_edge);
}

TEST_F(CameraTest, APostureGivesTheSamePixelsAgain) {
  const auto near = posture({{0, 0, 1.5}, {-1, 0, 1.5}});
  auto turned = near;
  turned[8] = 0.7;  // the first module's dock joint
  const View view = view_of(*camera_, near);
  const Picture first = take(near, view);
  EXPECT_NE(take(turned, view).rgb, first.rgb);
  EXPECT_EQ(take(near, view).rgb, first.rgb);
}

TEST_F(CameraTest, RefusesAPostureOfOthers) {
  const Result<Picture> refused = camera_->take(posture({{0, 0, 1}}), {});
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.error().message.find("15 numbers; this camera's has 30"), std::string::npos);
}

TEST(CameraWithoutEglTest, NamesWhatIsMissing) {
  const Result<Camera> camera = Camera::open(robot::legion(), 1, {.egl_library = "libNoSuchEgl.so.1"});
  ASSERT_FALSE(camera.ok());
  EXPECT_NE(camera.error().message.find("libNoSuchEgl.so.1"), std::string::npos);
  EXPECT_NE(camera.error().message.find("libegl1"), std::string::npos);
  // A library that is one, but no EGL.
  const Result<Camera> other = Camera::open(robot::legion(), 1, {.egl_library = "libm.so.6"});
  ASSERT_FALSE(other.ok());
  EXPECT_NE(other.error().message.find("libm.so.6"), std::string::npos);
  EXPECT_FALSE(Camera::open(robot::legion(), 0, {}).ok());
}

TEST(PostureTest, IsWhereTheModulesAre) {
  const std::vector<ModuleStart> starts{{.id = 7, .p_WB_m = {1, 2, 3}, .yaw_rad = 0.5, .hovering = true},
                                        {.id = 9, .p_WB_m = {-1, 0, 2}, .hovering = true}};
  const World world(still_world(), robot::legion(), starts);
  const std::vector<double> now = world.posture();
  ASSERT_EQ(now.size(), 30u);
  EXPECT_EQ(modules_of(now, robot::legion()), 2u);
  EXPECT_EQ(modules_of(std::vector<double>(29), robot::legion()), 0u);
  const std::vector<double> first{1, 2, 3, std::cos(0.25), 0, 0, std::sin(0.25), 0, 0};
  for (std::size_t i = 0; i < first.size(); ++i) EXPECT_NEAR(now[i], first[i], 1e-12) << i;
  EXPECT_EQ(now[15], -1);
  EXPECT_EQ(now[17], 2);
}

TEST(PostureTest, HoldsJointsAndGimbals) {
  World world(still_world(), robot::legion(), {{.id = 1, .p_WB_m = {0, 0, 2}, .hovering = true}});
  ActuatorFrame frame = hover_frame(LatchCommand::hold);
  frame.rotors[1].gimbal_rad = {0.2, -0.1};
  frame.joints[1].position_rad = 0.3;
  world.actuate(1, frame);
  world.advance(at_ms(1000));
  const std::vector<double> now = world.posture();
  EXPECT_NEAR(now[7], world.truth_joint(1, 0).position_rad, 0);
  EXPECT_NEAR(now[8], world.truth_joint(1, 1).position_rad, 0);
  EXPECT_NEAR(now[8], 0.3, 0.05);
  EXPECT_NEAR(now[9], 0, 1e-9);
  EXPECT_NEAR(now[11], 0.2, 1e-3);
  EXPECT_NEAR(now[12], -0.1, 1e-3);
}

TEST(PostureTest, APictureTakenOfAWorldDoesNotMoveIt) {
  const auto fly = [](bool with_pictures) {
    WorldConfig config;
    World world(config, robot::legion(), {{.id = 1, .p_WB_m = {0, 0, 2}, .hovering = true}});
    world.actuate(1, hover_frame(LatchCommand::hold));
    for (int ms = 100; ms <= 200; ms += 100) {
      world.advance(at_ms(ms));
      if (!with_pictures || ms > 100) continue;
      Result<Camera> camera = Camera::open(robot::legion(), 1, small);
      const std::vector<double> now = world.posture();
      if (camera) static_cast<void>(camera->take(now, camera->framing(std::span(&now, 1))));
    }
    return world.posture();
  };
  EXPECT_EQ(fly(true), fly(false));
}

}  // namespace
}  // namespace eciton::hal::sim
