#include "renderer/view_setup.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace ensemble {
namespace {

View someView() {
  View view;
  view.width = 640;
  view.height = 480;
  view.camera = {.position = Vec3(3.0f, 2.0f, 6.0f),
                 .target = Vec3(-1.0f, 0.5f, -2.0f),
                 .fov_y = 0.7f,
                 .near_plane = 0.2f};
  return view;
}

TEST(ClipFromWorld, DepthIsNearOverDistanceAndTheTargetIsInTheMiddle) {
  const View view = someView();
  const CameraFrame frame = cameraFrame(view.camera);
  const Mat4 clip_from_world = clipFromWorld(view);
  const Vec4 target = clip_from_world * Vec4(view.camera.target, 1.0f);
  EXPECT_NEAR(target.x / target.w, 0.0f, 1e-5f);
  EXPECT_NEAR(target.y / target.w, 0.0f, 1e-5f);
  EXPECT_NEAR(target.z / target.w, 0.2f / glm::length(view.camera.target - view.camera.position), 1e-6f);
  const Vec4 top =
      clip_from_world * Vec4(view.camera.position + frame.forward + std::tan(0.35f) * frame.up, 1.0f);
  EXPECT_NEAR(top.y / top.w, -1.0f, 1e-5f) << "y points down";
  const Vec4 right = clip_from_world *
                     Vec4(view.camera.position + frame.forward + std::tan(0.35f) * 4 / 3 * frame.right, 1.0f);
  EXPECT_NEAR(right.x / right.w, 1.0f, 1e-5f);
  const Vec4 infinite = clip_from_world * Vec4(frame.forward, 0.0f);
  EXPECT_EQ(infinite.z, 0.0f);
  EXPECT_NEAR(infinite.w, 1.0f, 1e-6f);
}

TEST(CameraFrame, HoldsForEveryDirection) {
  for (const Vec3 target : {Vec3(0, -1, 0), Vec3(0, 1, 0), Vec3(1, 0, 0), Vec3(0, 0, 1), Vec3(0, 0, 0)}) {
    SceneCamera camera;
    camera.position = Vec3(0.0f);
    camera.target = target;
    const CameraFrame frame = cameraFrame(camera);
    EXPECT_NEAR(glm::length(frame.right), 1.0f, 1e-5f);
    EXPECT_NEAR(glm::length(frame.up), 1.0f, 1e-5f);
    EXPECT_NEAR(glm::dot(glm::cross(frame.right, frame.up), -frame.forward), 1.0f, 1e-5f);
  }
}

TEST(Frustum, TouchesWhatItSees) {
  const View view = someView();
  const Frustum frustum = frustumOf(view);
  const CameraFrame frame = cameraFrame(view.camera);
  const auto at = [&](float right, float up, float forward) {
    return view.camera.position + right * frame.right + up * frame.up + forward * frame.forward;
  };
  EXPECT_TRUE(frustum.touches({at(0, 0, 5), 0.1f}));
  EXPECT_TRUE(frustum.touches({at(0, 0, 5000), 0.1f})) << "there is no far plane";
  EXPECT_FALSE(frustum.touches({at(0, 0, -1), 0.5f}));
  EXPECT_TRUE(frustum.touches({at(0, 0, -1), 1.5f}));
  const float edge = 5.0f * std::tan(0.35f);
  EXPECT_TRUE(frustum.touches({at(0, edge, 5), 0.01f}));
  EXPECT_FALSE(frustum.touches({at(0, edge + 0.2f, 5), 0.1f}));
  EXPECT_TRUE(frustum.touches({at(-edge * 4 / 3 - 0.1f, 0, 5), 0.2f}));
  EXPECT_FALSE(frustum.touches({at(-edge * 4 / 3 - 0.3f, 0, 5), 0.1f}));
}

// A tile's frustum is the picture's where it is all of it, and cut at its edges elsewhere.
TEST(Frustum, OfATile) {
  const View view = someView();
  const CameraFrame frame = cameraFrame(view.camera);
  const auto at = [&](float x, float y) {  // The ball about a pixel, 5 metres away.
    const float metres = 2.0f * std::tan(0.35f) * 5.0f / 480.0f;
    return Sphere{view.camera.position + 5.0f * frame.forward + (x - 320.0f) * metres * frame.right -
                      (y - 240.0f) * metres * frame.up,
                  0.001f};
  };
  const Frustum tile = frustumOf(view, {160, 240, 100, 50});
  EXPECT_TRUE(tile.touches(at(161, 241)));
  EXPECT_TRUE(tile.touches(at(259, 289)));
  EXPECT_FALSE(tile.touches(at(159, 260)));
  EXPECT_FALSE(tile.touches(at(261, 260)));
  EXPECT_FALSE(tile.touches(at(200, 239)));
  EXPECT_FALSE(tile.touches(at(200, 291)));
  const Frustum whole = frustumOf(view), same = frustumOf(view, wholeOf(view));
  for (int i = 0; i < 5; ++i) EXPECT_EQ(whole.planes[i], same.planes[i]);
}

TEST(MakeGpuView, TellsATileItsPlace) {
  const View view = someView();
  const GpuView gpu = makeGpuView(view, {160, 240, 100, 50}, fitShadowMap(view, {}));
  const GpuView whole = makeGpuView(view, wholeOf(view), fitShadowMap(view, {}));
  EXPECT_EQ(gpu.ambient_down.w, 160.0f);
  EXPECT_EQ(gpu.horizon.w, 240.0f);
  EXPECT_EQ(whole.ambient_down.w, 0.0f);
  EXPECT_EQ(whole.horizon.w, 0.0f);
  EXPECT_EQ(gpu.ray_origin, whole.ray_origin);
  EXPECT_EQ(gpu.clip_from_world, whole.clip_from_world);
}

TEST(FindVisible, ListsNumbersAscending) {
  const View view = someView();
  const std::vector<Sphere> bounds = {{view.camera.target, 1.0f},
                                      {view.camera.position + Vec3(0, 0, 50), 1.0f},
                                      {view.camera.target + Vec3(0.5f, 0, 0), 1.0f}};
  std::vector<std::uint32_t> visible = {7, 7};
  findVisible(frustumOf(view), bounds, visible);
  EXPECT_THAT(visible, ::testing::ElementsAre(0u, 2u));
}

TEST(ShadowFit, HoldsTheVisibleAndTheirDepths) {
  const View view = someView();
  std::vector<Sphere> bounds;
  for (int i = 0; i < 20; ++i)
    bounds.push_back(
        {Vec3(-3.0f + static_cast<float>(i % 5), 0.9f, -6.0f + static_cast<float>(i / 5)), 1.1f});
  const ShadowFit fit = fitShadowMap(view, bounds);
  EXPECT_EQ(fit.size, 1024u);
  for (const Sphere& sphere : bounds) {
    const Vec4 center = fit.shadow_from_world * Vec4(sphere.center, 1.0f);
    const float radius = 2.0f * sphere.radius / (fit.texel_side * static_cast<float>(fit.size));
    EXPECT_LE(std::abs(center.x) + radius, 1.0f + 3.0f / 1024);
    EXPECT_LE(std::abs(center.y) + radius, 1.0f + 3.0f / 1024);
    EXPECT_GE(center.z, 0.0f);
    EXPECT_LE(center.z, 1.0f);
  }
  std::vector<std::uint32_t> casters;
  findCasters(fit, bounds, casters);
  EXPECT_EQ(casters.size(), bounds.size());
  bounds.push_back({Vec3(300.0f, 1.0f, 0.0f), 1.0f});
  findCasters(fit, bounds, casters);
  EXPECT_EQ(casters.size(), bounds.size() - 1);
}

// The sun's side is nearer to 1, and a texel of the map is where it was after the crowd moved.
TEST(ShadowFit, MovesByWholeTexels) {
  const View view = someView();
  std::vector<Sphere> bounds = {{view.camera.target, 3.0f}};
  const ShadowFit before = fitShadowMap(view, bounds);
  const Vec3 to_sun = -glm::normalize(view.light.direction);
  const Vec3 point(0.3f, 0.1f, -0.4f);
  EXPECT_GT((before.shadow_from_world * Vec4(point + to_sun, 1.0f)).z,
            (before.shadow_from_world * Vec4(point, 1.0f)).z);
  bounds[0].center += Vec3(0.137f, 0.0f, 0.071f);
  const ShadowFit after = fitShadowMap(view, bounds);
  EXPECT_EQ(before.texel_side, after.texel_side);
  const Vec4 shift =
      (after.shadow_from_world - before.shadow_from_world) * Vec4(point, 1.0f) * 0.5f * 1024.0f;
  EXPECT_NEAR(shift.x, std::round(shift.x), 0.02f);
  EXPECT_NEAR(shift.y, std::round(shift.y), 0.02f);
  EXPECT_GT(std::abs(shift.x) + std::abs(shift.y), 1.0f);
}

TEST(Frustum, TouchesBoxes) {
  const View view = someView();
  const Frustum frustum = frustumOf(view);
  const auto around = [](Vec3 center, float half) { return Box{center - Vec3(half), center + Vec3(half)}; };
  EXPECT_TRUE(frustum.touches(around(view.camera.target, 0.1f)));
  EXPECT_TRUE(frustum.touches(around(view.camera.position, 500.0f))) << "the camera stands in it";
  const Vec3 forward = glm::normalize(view.camera.target - view.camera.position);
  EXPECT_FALSE(frustum.touches(around(view.camera.position - 10.0f * forward, 1.0f)));
  const Vec3 right = cameraFrame(view.camera).right;
  const Vec3 edge = view.camera.position + 10.0f * (forward + right * std::tan(0.35f) * 4.0f / 3.0f);
  EXPECT_TRUE(frustum.touches(around(edge + 0.4f * right, 0.5f)));
  EXPECT_FALSE(frustum.touches(around(edge + 2.0f * right, 0.5f)));
}

/// Where a point lies in a shadow map, and whether that is inside.
bool holds(const ShadowFit& fit, Vec3 point) {
  const Vec4 place = fit.shadow_from_world * Vec4(point, 1.0f);
  return std::abs(place.x) <= 1.0f && std::abs(place.y) <= 1.0f && place.z >= 0.0f && place.z <= 1.0f;
}

TEST(ShadowFit, AnEnvironmentWidensIt) {
  const View view = someView();
  const Vec3 person = view.camera.target;
  const std::vector<Sphere> bounds = {{person, 1.0f}};
  const ShadowFit alone = fitShadowMap(view, bounds);
  const Box room{person - Vec3(6.0f, 1.0f, 6.0f), person + Vec3(6.0f, 5.0f, 6.0f)};
  const ShadowFit in_room = fitShadowMap(view, bounds, room);
  const auto side = [](const ShadowFit& fit) { return fit.texel_side * static_cast<float>(fit.size); };
  const Vec3 before = person + Vec3(0.0f, -0.9f, 2.0f);  // seen, and beside the person
  EXPECT_FALSE(holds(alone, before));
  EXPECT_TRUE(holds(in_room, before));
  EXPECT_TRUE(holds(in_room, person));
  EXPECT_LE(side(in_room), 40.0f * std::exp2(0.25f) * 1.02f);
  // However large the set, the map stays about the people.
  const Box city{Vec3(-900.0f), Vec3(900.0f)};
  const ShadowFit in_city = fitShadowMap(view, bounds, city);
  EXPECT_TRUE(holds(in_city, person));
  EXPECT_LE(side(in_city), 40.0f * std::exp2(0.25f) * 1.02f);
  const std::vector<Sphere> crowd = {{person, 30.0f}};
  EXPECT_LE(side(fitShadowMap(view, crowd, city)), 2.0f * std::exp2(0.5f) * side(fitShadowMap(view, crowd)));
  // What stands far away, unseen, changes nothing but depths.
  const Box behind{view.camera.position + Vec3(0.0f, 0.0f, 900.0f),
                   view.camera.position + Vec3(1.0f, 1.0f, 901.0f)};
  EXPECT_EQ(fitShadowMap(view, bounds, behind).texel_side, alone.texel_side);
  // Without people it is about what is seen of the set.
  EXPECT_TRUE(holds(fitShadowMap(view, {}, room), person));
}

TEST(ShadowFit, BoxesCastWhereverTheyStandTowardsTheSun) {
  const View view = someView();
  const std::vector<Sphere> bounds = {{view.camera.target, 1.0f}};
  const ShadowFit fit = fitShadowMap(view, bounds);
  const Vec3 to_sun = -glm::normalize(view.light.direction);
  const auto around = [](Vec3 center, float half) { return Box{center - Vec3(half), center + Vec3(half)}; };
  EXPECT_TRUE(mayCast(fit, around(view.camera.target, 0.1f)));
  EXPECT_TRUE(mayCast(fit, around(view.camera.target + 300.0f * to_sun, 0.1f)));
  const Vec3 aside = glm::normalize(glm::cross(to_sun, Vec3(0.0f, 1.0f, 0.0f)));
  EXPECT_FALSE(mayCast(fit, around(view.camera.target + 20.0f * aside, 0.1f)));
  EXPECT_TRUE(mayCast(fit, around(view.camera.target + 20.0f * aside, 25.0f)));
}

TEST(ShadowFit, NobodyIsNoTrouble) {
  const ShadowFit fit = fitShadowMap(someView(), {});
  EXPECT_GT(fit.texel_side, 0.0f);
  for (int column = 0; column < 4; ++column) {
    for (int row = 0; row < 4; ++row) EXPECT_TRUE(std::isfinite(fit.shadow_from_world[column][row]));
  }
}

TEST(MakeGpuView, RaysMeetWhatTheMatrixProjects) {
  const View view = someView();
  const GpuView gpu = makeGpuView(view, wholeOf(view), fitShadowMap(view, {}));
  const Vec2 pixel(123.5f, 345.5f);
  const Vec3 ray = Vec3(gpu.ray_origin) + pixel.x * Vec3(gpu.ray_x) + pixel.y * Vec3(gpu.ray_y);
  const Vec4 clip = gpu.clip_from_world * Vec4(view.camera.position + 7.0f * ray, 1.0f);
  EXPECT_NEAR((clip.x / clip.w + 1.0f) * 320.0f, pixel.x, 1e-2f);
  EXPECT_NEAR((clip.y / clip.w + 1.0f) * 240.0f, pixel.y, 1e-2f);
}

}  // namespace
}  // namespace ensemble
