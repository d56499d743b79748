#include "core/math.h"

#include <glm/gtc/matrix_transform.hpp>

namespace ensemble {

Mat4 toMatrix(const Transform& transform) {
  const Mat3 rotation = glm::mat3_cast(transform.rotation);
  return Mat4(Vec4(rotation[0] * transform.scale.x, 0.0f), Vec4(rotation[1] * transform.scale.y, 0.0f),
              Vec4(rotation[2] * transform.scale.z, 0.0f), Vec4(transform.translation, 1.0f));
}

Transform toTransform(const Mat4& matrix) {
  Transform result;
  result.translation = Vec3(matrix[3]);
  Mat3 basis(matrix);
  for (int axis = 0; axis < 3; ++axis) result.scale[axis] = glm::length(basis[axis]);
  if (glm::determinant(basis) < 0.0f) result.scale.x = -result.scale.x;
  for (int axis = 0; axis < 3; ++axis) {
    if (result.scale[axis] == 0.0f) return Transform{result.translation, Quat(1, 0, 0, 0), result.scale};
    basis[axis] /= result.scale[axis];
  }
  result.rotation = glm::normalize(glm::quat_cast(basis));
  return result;
}

}  // namespace ensemble
