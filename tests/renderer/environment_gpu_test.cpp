// A static set among people: what it shows, hides and shades.
#include "core/input_error.h"
#include "renderer/view_setup.h"
#include "tests/renderer/gpu_fixture.h"
#include "tests/renderer/pixel_ray.h"
#include "tests/support/small_sets.h"

namespace ensemble {
namespace {

using testing::GpuTest;
using testing::setOf;
using testing::wallAt;

class EnvironmentTest : public GpuTest {
 protected:
  /// One person at the origin, seen from 5 metres in front.
  static Scene onePerson() {
    Scene scene = testing::tubeScene(0);
    ScenePerson person;
    person.outfit.value = "tunic";
    person.tint = 3u;
    scene.people.push_back(person);
    scene.camera.position = Vec3(0.0f, 1.2f, 5.0f);
    scene.camera.target = Vec3(0.0f, 0.95f, 0.0f);
    scene.environment.value = "memory";
    scene.ground = false;
    return scene;
  }
  static View viewWithAovs(const Scene& scene) {
    View view = viewOf(scene);
    view.aovs = testing::allAovs();
    return view;
  }
  Picture drawSet(const Scene& scene, const RawAsset& set, const View& view, RendererOptions options = {}) {
    options.validate = testing::hasValidationLayer();
    Renderer renderer(options);
    const EnvironmentMesh mesh = buildEnvironmentMesh(set, "set.glb");
    renderer.load(scene, wardrobes_, &mesh);
    return draw(renderer, view);
  }
  Picture drawWithout(Scene scene, const View& view) {
    scene.environment.value.clear();
    return drawScene(scene, view);
  }
  static std::array<int, 4> pixelAt(const Picture& picture, std::size_t i) {
    const std::uint8_t* rgba = picture.color.rgba.data() + 4 * i;
    return {rgba[0], rgba[1], rgba[2], rgba[3]};
  }
};

TEST_F(EnvironmentTest, AWallHidesThePersonBehindIt) {
  const Scene scene = onePerson();
  const View view = viewWithAovs(scene);
  const Picture alone = drawWithout(scene, view);
  ASSERT_GT(testing::countPeoplePixels(alone), 500u);
  // The right half of the picture, a metre before the person.
  const RawPrimitive wall = wallAt(1.0f, 0.0f, 20.0f, 20.0f);
  const Picture picture = drawSet(scene, setOf({wall}), view);
  std::size_t hidden = 0, kept = 0;
  for (std::uint32_t y = 0; y < view.height; ++y) {
    for (std::uint32_t x = 0; x < view.width; ++x) {
      const std::size_t i = std::size_t{y} * view.width + x;
      const auto& v = wall.vertices;
      const auto first = testing::intersect(view, x, y, {v[0].position, v[1].position, v[2].position});
      const auto second = testing::intersect(view, x, y, {v[0].position, v[2].position, v[3].position});
      const float outside = std::min(first.outside, second.outside);
      if (std::abs(outside) < 1e-3f) continue;  // on an edge
      if (outside > 0.0f) {
        EXPECT_EQ(picture.character[i], alone.character[i]);
        EXPECT_EQ(picture.face[i], alone.face[i]);
        kept += picture.character[i] != 0;
        continue;
      }
      EXPECT_EQ(picture.character[i], 0u);
      EXPECT_EQ(picture.region[i], 0u);
      EXPECT_EQ(picture.face[i], 0u);
      EXPECT_NEAR(picture.depth[i], first.depth, 2e-5f * first.depth);
      EXPECT_EQ(picture.normal[3 * i + 2], 1.0f);
      hidden += alone.character[i] != 0;
    }
  }
  EXPECT_GT(hidden, 200u);
  EXPECT_GT(kept, 200u);
}

TEST_F(EnvironmentTest, AWallBehindThePersonIsHiddenByHim) {
  const Scene scene = onePerson();
  const View view = viewWithAovs(scene);
  const Picture alone = drawWithout(scene, view);
  const Picture picture = drawSet(scene, setOf({wallAt(-2.0f, -20.0f, 20.0f, 20.0f)}), view);
  EXPECT_EQ(picture.character, alone.character);
  EXPECT_EQ(picture.face, alone.face);
  EXPECT_GT(picture.depth[0], 6.0f);
}

// Single-sided faces are not seen from behind, double-sided ones are, lit from where they are seen.
TEST_F(EnvironmentTest, SidesAreThoseOfTheMaterial) {
  const Scene scene = onePerson();
  const View view = viewWithAovs(scene);
  RawAsset back = setOf({testing::quad(0, Vec3(20, -20, -2), Vec3(-40, 0, 0), Vec3(0, 40, 0))});
  EXPECT_EQ(drawSet(scene, back, view).depth[0], 0.0f);
  back.materials[0].double_sided = true;
  const Picture picture = drawSet(scene, back, view);
  EXPECT_GT(picture.depth[0], 6.0f);
  EXPECT_EQ(picture.normal[2], 1.0f);
  EXPECT_EQ(
      pixelAt(picture, 0),
      pixelAt(
          drawSet(scene, setOf({testing::quad(0, Vec3(-20, -20, -2), Vec3(40, 0, 0), Vec3(0, 40, 0))}), view),
          0));
}

TEST_F(EnvironmentTest, TexturesAndMasksAreThoseOfTheMaterial) {
  const Scene scene = onePerson();
  for (const std::uint32_t samples : {1u, 4u}) {
    View view = viewWithAovs(scene);
    view.samples = samples;
    view.background = BackgroundKind::kTransparent;
    // Before the person: 4 x 4 squares of 0.5 m, red ones and holes.
    RawAsset set = setOf({wallAt(1.0f, -1.0f, 1.0f, 2.0f)});
    set.images.push_back(testing::checkerImage({200, 0, 0, 255}, {200, 0, 0, 0}));
    set.materials[0].image = 0;
    set.materials[0].alpha_mode = AlphaMode::kMask;
    const Picture picture = drawSet(scene, set, view);
    const auto pixelOf = [&](Vec3 world) {
      const Vec4 clip = clipFromWorld(view) * Vec4(world, 1.0f);
      const auto x =
          static_cast<std::size_t>((clip.x / clip.w * 0.5f + 0.5f) * static_cast<float>(view.width));
      const auto y =
          static_cast<std::size_t>((clip.y / clip.w * 0.5f + 0.5f) * static_cast<float>(view.height));
      return y * view.width + x;
    };
    // v runs up the quad here: the image's first row of squares is the lowest.
    const std::size_t red = pixelOf({-0.75f, 0.25f, 1.0f}), hole = pixelOf({-0.75f, 0.75f, 1.0f});
    EXPECT_NEAR(picture.depth[red], 4.0f, 0.2f);
    EXPECT_GT(pixelAt(picture, red)[0], 40);
    EXPECT_EQ(pixelAt(picture, red)[1], 0);
    EXPECT_EQ(pixelAt(picture, red)[3], 255);
    EXPECT_EQ(picture.depth[hole], 0.0f);
    EXPECT_EQ(pixelAt(picture, hole)[3], 0);
    EXPECT_GT(testing::countPeoplePixels(picture), 100u) << "through the holes";
  }
}

TEST_F(EnvironmentTest, IsDrawnOnATransparentBackground) {
  const Scene scene = onePerson();
  View view = viewOf(scene);
  view.background = BackgroundKind::kTransparent;
  const Picture picture = drawSet(scene, setOf({wallAt(-2.0f, 0.0f, 20.0f, 20.0f)}), view);
  const std::size_t row = std::size_t{view.width} * 30;
  EXPECT_EQ(pixelAt(picture, row + 2)[3], 0) << "where nothing stands";
  EXPECT_EQ(pixelAt(picture, row + view.width - 3)[3], 255) << "the wall";
  view.samples = 4;
  EXPECT_EQ(pixelAt(drawSet(scene, setOf({wallAt(-2.0f, 0.0f, 20.0f, 20.0f)}), view), row + 2)[3], 0);
}

// A roof over everything: what is below is in its shadow, whichever side it turns to the sun.
TEST_F(EnvironmentTest, CastsShadowsOnPeopleGroundAndItself) {
  Scene scene = onePerson();
  scene.light.direction = Vec3(-0.2f, -1.0f, -0.1f);
  scene.camera.position = Vec3(0.0f, 2.0f, 6.0f);
  View view = viewWithAovs(scene);
  for (const bool has_ground : {true, false}) {
    view.ground = has_ground;
    std::vector<RawPrimitive> quads;
    if (!has_ground) quads.push_back(testing::floorAt(0.0f, 30.0f));
    const Picture open = has_ground ? drawWithout(scene, view) : drawSet(scene, setOf(quads), view);
    for (const bool looks_up : {true, false}) {
      RawPrimitive roof = testing::floorAt(8.0f, 30.0f);
      if (!looks_up) {
        for (Triangle& face : roof.faces) std::swap(face[1], face[2]);
      }
      std::vector<RawPrimitive> covered = quads;
      covered.push_back(roof);
      const Picture shaded = drawSet(scene, setOf(covered), view);
      std::size_t people = 0, ground = 0;
      for (std::size_t i = 0; i < open.depth.size(); ++i) {
        // Near the person, whom the map is about.
        if (open.depth[i] == 0.0f || open.depth[i] > 9.0f || open.depth[i] != shaded.depth[i]) continue;
        const std::array<int, 4> light = pixelAt(open, i), dark = pixelAt(shaded, i);
        for (std::size_t k = 0; k < 3; ++k) EXPECT_LE(dark[k], light[k]);
        if (dark[1] + 10 >= light[1]) continue;
        ++(open.character[i] != 0 ? people : ground);
      }
      EXPECT_GT(people, 150u) << has_ground << looks_up;
      EXPECT_GT(ground, 3000u) << has_ground << looks_up;
    }
  }
}

TEST_F(EnvironmentTest, TakesTheShadowsOfPeople) {
  Scene scene = onePerson();
  scene.camera.position = Vec3(0.0f, 5.0f, 5.0f);
  View view = viewWithAovs(scene);
  const RawAsset floor = setOf({testing::floorAt(0.0f, 30.0f)});
  const Picture lit = drawSet(scene, floor, view);
  view.light.shadows = false;
  const Picture unlit = drawSet(scene, floor, view);
  std::size_t darker = 0, spotted = 0;
  for (std::size_t i = 0; i < lit.character.size(); ++i) {
    if (lit.character[i] != 0) continue;
    const int difference = unlit.color.rgba[4 * i] - lit.color.rgba[4 * i];
    darker += difference > 20;
    // Far from the person nothing shades the floor, least of all itself.
    spotted += difference != 0 && i % view.width < view.width / 4;
  }
  EXPECT_GT(darker, 60u);
  EXPECT_EQ(spotted, 0u);
}

TEST_F(EnvironmentTest, TilesShowWhatTheWholeShows) {
  const Scene scene = onePerson();
  View view = viewWithAovs(scene);
  view.samples = 4;
  const RawAsset set = setOf({testing::floorAt(0.0f, 10.0f), wallAt(-2.0f, -3.0f, 1.0f, 3.0f)});
  const Picture whole = drawSet(scene, set, view);
  const Picture tiled = drawSet(scene, set, view, {.tiles = {.side = 64, .pixels = 64 * 64}});
  std::size_t others = 0;
  for (std::size_t i = 0; i < whole.depth.size(); ++i) {
    others += whole.character[i] != tiled.character[i] ||
              std::abs(whole.depth[i] - tiled.depth[i]) > 1e-3f * whole.depth[i];
  }
  EXPECT_LE(others, 4u) << "of 19,200: where edges fall to the other side";
  EXPECT_LE(testing::differingPixels(whole.color, tiled.color).size(), 20u);
  EXPECT_EQ(tiled.stats.environment_bytes, whole.stats.environment_bytes);
  EXPECT_GT(tiled.stats.environment.draw_calls, whole.stats.environment.draw_calls);
  EXPECT_EQ(whole.stats.environment.draw_calls, 2u) << "one piece, twice";
}

TEST_F(EnvironmentTest, IsCountedApart) {
  const Scene scene = onePerson();
  const View view = viewOf(scene);
  RawAsset set = setOf(
      {testing::floorAt(0.0f, 10.0f), testing::quad(1, Vec3(500, 0, 500), Vec3(1, 0, 0), Vec3(0, 1, 0))});
  set.materials.push_back(testing::setMaterial("out of sight", Vec3(0.5f)));
  const FrameStats alone = drawWithout(scene, view).stats;
  const FrameStats with = drawSet(scene, set, view).stats;
  EXPECT_EQ(alone.environment.draw_calls, 0u);
  EXPECT_EQ(alone.environment_bytes, 0u);
  EXPECT_EQ(with.environment.draw_calls, 2u) << "the floor in two passes, the other piece in none";
  EXPECT_EQ(with.environment.triangles, 4u);
  EXPECT_EQ(with.environment_bytes, 2u * (4 * 24 + 6 * 2));
  EXPECT_EQ(with.gpu_mesh_bytes, alone.gpu_mesh_bytes);
  EXPECT_EQ(with.characters_drawn, alone.characters_drawn);
  EXPECT_EQ(with.main.triangles, alone.main.triangles + 2);
  EXPECT_EQ(with.shadow.triangles, alone.shadow.triangles + 2);
  EXPECT_EQ(with.drawCalls(), alone.drawCalls() + 2);
  if (!alone.vertexInvocations()) return;
  EXPECT_EQ(*alone.environment.vertex_invocations, 0u);
  EXPECT_EQ(*with.vertexInvocations(), *alone.vertexInvocations() + *with.environment.vertex_invocations);
  EXPECT_GE(*with.environment.vertex_invocations, 8u);
}

TEST_F(EnvironmentTest, MoreTexturesThanAnArrayHoldsAreRefused) {
  const Scene scene = onePerson();
  RawAsset set = setOf({testing::floorAt(0.0f, 10.0f)});
  set.images.assign(1u << 17, testing::checkerImage({200, 0, 0, 255}, {200, 0, 0, 0}));
  set.materials[0].image = 0;
  try {
    drawSet(scene, set, viewOf(scene));
    FAIL() << "no device has as many layers";
  } catch (const SystemError& error) {
    EXPECT_THAT(error.what(),
                ::testing::HasSubstr(": 131072 textures of 256 x 256 texels are more than its "));
    EXPECT_THAT(error.what(), ::testing::EndsWith("; use fewer textures"));
  }
}

// A set larger than a buffer is drawn from several, and is the same picture.
TEST_F(EnvironmentTest, ManyBuffersMakeTheSamePicture) {
  const Scene scene = onePerson();
  const View view = viewWithAovs(scene);
  std::vector<RawPrimitive> steps;
  for (int i = 0; i < 60; ++i) {
    steps.push_back(
        wallAt(-1.0f - 0.1f * static_cast<float>(i), -3.0f, 3.0f, 0.05f * static_cast<float>(i + 1)));
    steps.back().material = static_cast<std::uint32_t>(i);
  }
  RawAsset set = setOf(std::move(steps));
  while (set.materials.size() < 60) {
    const float shade = static_cast<float>(set.materials.size()) / 60.0f;
    set.materials.push_back(testing::setMaterial("step", Vec3(shade, 0.5f, 1.0f - shade)));
  }
  const Picture one = drawSet(scene, set, view);
  const Picture many = drawSet(scene, set, view, {.max_buffer_bytes = 5000});
  EXPECT_EQ(one.color.rgba, many.color.rgba);
  EXPECT_EQ(one.depth, many.depth);
}

}  // namespace
}  // namespace ensemble
