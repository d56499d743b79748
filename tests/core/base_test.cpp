#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/check.h"
#include "core/hash.h"
#include "core/ids.h"
#include "core/input_error.h"
#include "core/math.h"

namespace ensemble {
namespace {

TEST(InputError, JoinsItsPartsIntoOneLine) {
  const InputError error({"a.glb", "/nodes/3", "mesh 7 does not exist", "export the file again"});
  EXPECT_STREQ(error.what(), "a.glb: /nodes/3: mesh 7 does not exist; export the file again");
  EXPECT_EQ(error.exitCode(), ExitCode::kInvalidInput);
}

TEST(InputError, LeavesOutEmptyPartsAndTamesControlCharacters) {
  const SystemError error({"", "", "bad name 'a\nb'", ""});
  EXPECT_STREQ(error.what(), "bad name 'a?b'");
}

TEST(Check, PrintsBothValues) {
  const int left = 3;
  try {
    ENSEMBLE_CHECK(left == 4);
    FAIL() << "did not throw";
  } catch (const CheckError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("check failed: left == 4 (3 vs. 4)"));
  }
  EXPECT_NO_THROW(ENSEMBLE_CHECK(left == 3));
  EXPECT_THROW(ENSEMBLE_CHECK(left > 3), CheckError);
  EXPECT_THROW(ENSEMBLE_CHECK(false), CheckError);
}

TEST(Hash, IsSha256) {
  // FIPS 180-4, the message "abc".
  const std::string text = "abc";
  EXPECT_EQ(sha256Hex(std::as_bytes(std::span(text.data(), text.size()))),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST(Math, TransformSurvivesItsMatrix) {
  const Transform transform{{1, 2, 3}, glm::angleAxis(0.7f, glm::normalize(Vec3(1, 2, -1))), {2, 0.5f, 1}};
  const Transform back = toTransform(toMatrix(transform));
  EXPECT_NEAR(glm::distance(back.translation, transform.translation), 0.0f, 1e-6f);
  EXPECT_NEAR(glm::distance(back.scale, transform.scale), 0.0f, 1e-5f);
  EXPECT_NEAR(std::abs(glm::dot(back.rotation, transform.rotation)), 1.0f, 1e-6f);
}

TEST(Math, MirroringBecomesANegativeScale) {
  const Transform mirrored{{0, 0, 0}, Quat(1, 0, 0, 0), {-2, 1, 1}};
  EXPECT_LT(toTransform(toMatrix(mirrored)).scale.x, 0.0f);
}

TEST(Ids, AreNotInterchangeable) {
  static_assert(!std::is_convertible_v<FaceId, RegionId>);
  PerFace<int> values(3, 7);
  EXPECT_EQ(values[FaceId(2)], 7);
  EXPECT_FALSE(FaceId().valid());
}

}  // namespace
}  // namespace ensemble
