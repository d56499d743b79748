// Who is in sight, who casts a shadow, who is shown at which key frame: verdicts that the host and the device
// reach alike, to the last bit. So they take sums, differences, products and comparisons alone, which both
// round correctly, in one order, and none of them fused; what needs a division or a root is prepared by the
// host, or squared. Compiled by C++ and GLSL.
#ifndef ENSEMBLE_SHADERS_SHARED_CULLING_H
#define ENSEMBLE_SHADERS_SHARED_CULLING_H

#ifdef __cplusplus
#include "core/math.h"

namespace ensemble::culling {
using glm::abs, glm::max, glm::min, glm::vec3, glm::vec4;
using uint = unsigned int;
#ifndef ENSEMBLE_SHARED_FUNCTION
#define ENSEMBLE_SHARED_FUNCTION inline
#endif
#define ENSEMBLE_EXACT
#else
#ifndef ENSEMBLE_SHARED_FUNCTION
#define ENSEMBLE_SHARED_FUNCTION
#endif
#define ENSEMBLE_EXACT precise
#endif

/// dot(row, (point, 1))
ENSEMBLE_SHARED_FUNCTION float timesPoint(vec4 row, vec3 point) {
  ENSEMBLE_EXACT float sum = row.x * point.x;
  sum = sum + row.y * point.y;
  sum = sum + row.z * point.z;
  sum = sum + row.w;
  return sum;
}

/// Whether a ball lies behind a plane. @param ball centre and radius
ENSEMBLE_SHARED_FUNCTION bool isBehind(vec4 plane, vec4 ball) {
  return timesPoint(plane, vec3(ball.x, ball.y, ball.z)) < -ball.w;
}

/// Whether a ball may cast into a shadow map. @param across_x, across_y rows to -1 .. 1 over the map
/// @param scale of a length, likewise
ENSEMBLE_SHARED_FUNCTION bool castsInto(vec4 across_x, vec4 across_y, float scale, vec4 ball) {
  vec3 center = vec3(ball.x, ball.y, ball.z);
  ENSEMBLE_EXACT float reach = ball.w * scale;
  reach = reach + 1.0f;
  return abs(timesPoint(across_x, center)) <= reach && abs(timesPoint(across_y, center)) <= reach;
}

/// Whether somebody's height on the screen, by the distance of its middle, is less than a number of pixels.
/// @param eye where the camera is; w: square of the least distance that counts
/// @param pixels that a metre has, one metre away @param below_squared that number's square
ENSEMBLE_SHARED_FUNCTION bool isSmall(vec3 feet, float height, vec4 eye, float pixels, float below_squared) {
  ENSEMBLE_EXACT float x = feet.x - eye.x;
  ENSEMBLE_EXACT float y = height * 0.5f;
  y = feet.y + y;
  y = y - eye.y;
  ENSEMBLE_EXACT float z = feet.z - eye.z;
  ENSEMBLE_EXACT float distance_squared = x * x;
  distance_squared = distance_squared + y * y;
  distance_squared = distance_squared + z * z;
  distance_squared = max(distance_squared, eye.w);
  ENSEMBLE_EXACT float size = pixels * height;
  size = size * size;
  distance_squared = distance_squared * below_squared;
  return size < distance_squared;
}

/// The key of a clip that is nearest to a phase. @param last the clip's last key
ENSEMBLE_SHARED_FUNCTION uint nearestKeyAt(float phase, uint last) {
  ENSEMBLE_EXACT float at = phase * float(last);
  at = at + 0.5f;
  return min(uint(at), last);
}

#ifdef __cplusplus
}  // namespace ensemble::culling
#endif
#endif
