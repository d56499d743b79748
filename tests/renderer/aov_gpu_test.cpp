// AOVs against rays cast at people who are skinned on the CPU.
#include "tests/renderer/gpu_fixture.h"
#include "tests/renderer/pixel_ray.h"

namespace ensemble {
namespace {

using testing::GpuTest;
using testing::Hit;
using testing::intersect;

class AovTest : public GpuTest {
 protected:
  /// The corners of a face in the world, by the rules of design 9: interpolated matrices.
  std::array<Vec3, 3> corners(const Character& person, std::span<const RawVertex> vertices,
                              const Triangle& face, double seconds) const {
    const TemplateBody& body = wardrobes_[0].body;
    const Clip& clip = body.clips[person.clip];
    const double turns = person.phase + person.speed * seconds / clip.seconds;
    const double at = (turns - std::floor(turns)) * (clip.key_count - 1);
    const auto key = static_cast<std::uint32_t>(at);
    const auto part = static_cast<float>(at - key);
    std::vector<Mat4> matrices = skinningMatrices(body.skeleton, clip.key(key));
    const std::vector<Mat4> next =
        skinningMatrices(body.skeleton, clip.key(std::min(key + 1, clip.key_count - 1)));
    for (std::size_t i = 0; i < matrices.size(); ++i)
      matrices[i] = matrices[i] * (1.0f - part) + next[i] * part;
    std::array<Vec3, 3> result;
    for (std::size_t i = 0; i < 3; ++i) {
      const RawVertex& vertex = vertices[face[i]];
      const Vec3 model = skinPosition(vertex, matrices);
      result[i] = Vec3(person.worldFromModel() * Vec4(model, 1.0f));
    }
    return result;
  }
};

TEST_F(AovTest, EveryPixelShowsTheFaceThatItNames) {
  Scene scene = testing::tubeScene(8);
  scene.crowd.scale = {0.9f, 1.1f};
  View view = viewOf(scene);
  view.snap_below = 0.0f;
  view.aovs = testing::allAovs();
  view.ground = false;
  const double seconds = 0.37;
  const auto renderer = makeRenderer(scene);
  const Picture picture = draw(*renderer, view, seconds);
  const AovNumbers& numbers = renderer->aovNumbers();
  const Wardrobe& wardrobe = wardrobes_[0];
  ASSERT_EQ(numbers.first_garment, 4u);

  std::size_t body_pixels = 0, extra_pixels = 0, garment_pixels = 0;
  for (std::uint32_t y = 0; y < view.height; ++y) {
    for (std::uint32_t x = 0; x < view.width; ++x) {
      const std::size_t i = std::size_t{y} * view.width + x;
      if (picture.character[i] == 0) {
        EXPECT_EQ(picture.region[i], 0u);
        EXPECT_EQ(picture.face[i], 0u);
        EXPECT_EQ(picture.depth[i], 0.0f);
        continue;
      }
      ASSERT_LE(picture.character[i], 8u);
      const Character& person = renderer->crowd().characters[picture.character[i] - 1];
      const ItemId item_id = renderer->crowd().combinations[person.combination].items.at(0);
      const Item& item = wardrobe.items[item_id];
      std::array<Vec3, 3> face;
      if (picture.region[i] < numbers.first_garment) {
        const std::uint32_t number = picture.face[i] - 1;
        const auto template_faces = static_cast<std::uint32_t>(wardrobe.body.faces.size());
        if (number < template_faces) {
          EXPECT_EQ(wardrobe.body.region_of_face[FaceId(number)].value + 1, picture.region[i]);
          EXPECT_NE(item.visible[FaceId(number)], 0);
          face = corners(person, wardrobe.body.vertices.raw(), wardrobe.body.faces[FaceId(number)], seconds);
        } else {  // a face that the template lacks
          const ExtraBodyPart& extra = item.extra_body.at(0);
          EXPECT_EQ(extra.region.value + 1, picture.region[i]);
          face = corners(person, extra.part.vertices, extra.part.faces.at(number - template_faces), seconds);
          ++extra_pixels;
        }
        ++body_pixels;
      } else {
        const std::string& name = numbers.garments.at(picture.region[i] - numbers.first_garment);
        const auto garment = std::find_if(item.garments.begin(), item.garments.end(),
                                          [&](const Garment& g) { return g.name == name; });
        ASSERT_NE(garment, item.garments.end()) << item.name << " has no " << name;
        face = corners(person, garment->parts[0].vertices, garment->parts[0].faces.at(picture.face[i] - 1),
                       seconds);
        ++garment_pixels;
      }
      const Hit hit = intersect(view, x, y, face);
      EXPECT_LT(hit.outside, 0.02f) << x << ", " << y;
      EXPECT_NEAR(hit.depth, picture.depth[i], 1e-3f) << x << ", " << y;
      const Vec3 normal(picture.normal[3 * i], picture.normal[3 * i + 1], picture.normal[3 * i + 2]);
      EXPECT_NEAR(glm::length(normal), 1.0f, 1e-3f);
      EXPECT_GT(std::abs(glm::dot(normal, hit.normal)), 0.7f) << "8 segments: 22.5 degrees, and the sway";
    }
  }
  EXPECT_GT(body_pixels, 500u);
  EXPECT_GT(extra_pixels, 5u);
  EXPECT_GT(garment_pixels, 500u);
}

TEST_F(AovTest, NormalsOfTwoSidedClothLookAtTheCamera) {
  Scene scene = testing::tubeScene(0);
  ScenePerson person;
  person.outfit.value = "tunic";
  scene.people.push_back(person);
  scene.camera.position = Vec3(0.0f, 4.0f, 0.8f);  // looks down into the tunic
  scene.camera.target = Vec3(0.0f, 1.0f, 0.0f);
  View view = viewOf(scene);
  view.aovs = testing::allAovs();
  const auto renderer = makeRenderer(scene);
  const Picture picture = draw(*renderer, view);
  const CameraFrame frame = cameraFrame(view.camera);
  std::size_t inside = 0;
  for (std::size_t i = 0; i < picture.region.size(); ++i) {
    if (picture.region[i] < renderer->aovNumbers().first_garment) continue;
    const Vec3 normal(picture.normal[3 * i], picture.normal[3 * i + 1], picture.normal[3 * i + 2]);
    // The tube stands upright, so that its outer normals point away from its axis.
    const float x = static_cast<float>(i % view.width) + 0.5f - static_cast<float>(view.width) / 2.0f;
    if (std::abs(x) > 5.0f && glm::dot(normal, frame.right) * x < 0.0f) ++inside;
  }
  EXPECT_GT(inside, 50u) << "its inner side shows, with the normals turned";
}

TEST_F(AovTest, TheGroundHidesWhatIsBelowItAndIsNobody) {
  Scene scene = testing::tubeScene(0);
  ScenePerson person;
  person.outfit.value = "tunic";
  person.position = Vec3(0.0f, -0.9f, 0.0f);
  scene.people.push_back(person);
  View view = viewOf(scene);
  view.aovs = testing::allAovs();
  const auto renderer = makeRenderer(scene);
  const Picture with_ground = draw(*renderer, view);
  view.ground = false;
  const Picture without = draw(*renderer, view);
  EXPECT_LT(testing::countPeoplePixels(with_ground), testing::countPeoplePixels(without));
  EXPECT_GT(testing::countPeoplePixels(with_ground), 0u);
  const std::size_t bottom = std::size_t{view.width} * (view.height - 1) + 2;
  EXPECT_EQ(with_ground.character[bottom], 0u);
  EXPECT_GT(with_ground.depth[bottom], 1.0f);
  EXPECT_EQ(with_ground.normal[3 * bottom + 1], 1.0f);
}

}  // namespace
}  // namespace ensemble
