// Hair and a cap: shells around the skull, cut along the hairline.
#include <algorithm>
#include <cmath>

#include "assetpipe/people_garments.h"

namespace ensemble {
namespace {

/// A point in the head's own measures: metres of the reference head, from between the ears.
Vec3 onHead(const Figure& f, const Vec3& p) { return (p - f.head_center) / f.head_size; }
Vec3 fromHead(const Figure& f, const Vec3& p) { return f.head_center + p * f.head_size; }

Solid skullShell(const Figure& f, const Vec3& center, const Vec3& radii) {
  return Solid::ellipsoid(fromHead(f, center), radii * f.head_size);
}

/// Hair over the forehead, which stands out before the skull.
void joinForehead(SolidGroup& hair, const Figure& f) {
  hair.join(skullShell(f, {0.0f, 0.034f, 0.022f}, {0.0670f, 0.0665f, 0.0725f}), 0.03f * f.head_size);
}

SkinBinding onHeadOnly() {
  SkinBinding skin;
  skin.joints[0] = kHead;
  skin.weights[0] = 1.0f;
  return skin;
}

/// Positive in front of the hairline, from the forehead past the temples to the sideburns; head's measures.
float hairline(const Vec3& h, float sideburn) {
  const float side = std::abs(h.x);
  // A curve on the forehead: highest in the middle, down along the temples to the ears.
  const float height = 0.050f - 9.0f * std::max(side - 0.015f, 0.0f) * std::max(side - 0.015f, 0.0f);
  const float forehead = smoothMin(height - h.y, h.z - 0.020f, 0.02f);
  const float temple = h.z - 0.026f - 0.12f * h.y;
  const float below_sideburn = std::min(sideburn - h.y, h.z + 0.002f);
  return std::max(std::min(forehead, temple), below_sideburn);
}

/// Positive below the line behind the ear down to the nape.
float napeLine(const Vec3& h, float nape) {
  const float line = nape + 0.62f * std::max(h.z + 0.085f, 0.0f);
  return std::min(line, -0.006f) - h.y;
}

/// Grooves as combed hair has them, metres of the reference head.
float strands(const Vec3& h, float depth) {
  const float around = std::atan2(h.x, -h.z + 0.02f);
  return depth *
         (0.6f * std::sin(26.0f * around + 14.0f * h.y) + 0.4f * std::sin(43.0f * around - 21.0f * h.y));
}

GarmentDesign startHair(const Figure& f, const char* name, const Palette& palette) {
  GarmentDesign design;
  design.name = name;
  design.materials = {clothMaterial(name, palette.main)};
  design.binding = [](const Vec3&) { return onHeadOnly(); };
  design.covers_skin = false;
  design.low = fromHead(f, Vec3(-0.16f, -0.20f, -0.24f));
  design.high = fromHead(f, Vec3(0.16f, 0.16f, 0.22f));
  design.hem = 0.009f;
  design.cell = 0.0045f;
  design.face_count = 900;
  return design;
}

}  // namespace

GarmentDesign designShortHair(const Figure& f, const Palette& palette) {
  GarmentDesign design = startHair(f, "hair.short", palette);
  SolidGroup hair;
  const float size = f.head_size;
  hair.join(skullShell(f, {0.0f, 0.012f, -0.012f}, {0.0835f, 0.0955f, 0.1045f}), 0.0f);
  joinForehead(hair, f);
  hair.join(skullShell(f, {0.012f, 0.062f, 0.022f}, {0.060f, 0.042f, 0.062f}), 0.03f * size);
  design.symmetric = false;
  design.shell = [&f, hair, size](const Vec3& p) {
    const Vec3 h = onHead(f, p);
    return hair.distance(p) - size * strands(h, 0.0013f) * smoothStep(-0.065f, -0.025f, h.y);
  };
  design.opening = [&f, size](const Vec3& p) {
    const Vec3 h = onHead(f, p);
    return size * std::max(hairline(h, -0.030f), napeLine(h, -0.070f));
  };
  design.face_count = 800;
  return design;
}

GarmentDesign designBob(const Figure& f, const Palette& palette) {
  GarmentDesign design = startHair(f, "hair.bob", palette);
  const float size = f.head_size;
  SolidGroup hair;
  hair.join(skullShell(f, {0.0f, 0.014f, -0.012f}, {0.090f, 0.098f, 0.110f}), 0.0f);
  joinForehead(hair, f);
  const LoftFrame frame{f.head_center, Mat3(1.0f)};
  const auto row = [size](float y, float z, float side, float front, float back) {
    return LoftRow{y * size, 0, z * size, side * size, front * size, back * size};
  };
  hair.join(Solid::loft(frame, {row(-0.150f, -0.022f, 0.078f, 0.050f, 0.062f),
                                row(-0.105f, -0.016f, 0.094f, 0.062f, 0.082f),
                                row(-0.050f, -0.012f, 0.098f, 0.066f, 0.100f),
                                row(0.005f, -0.010f, 0.093f, 0.070f, 0.104f)}),
            0.03f * size);
  design.shell = [&f, hair, size](const Vec3& p) {
    const Vec3 h = onHead(f, p);
    return hair.distance(p) - size * strands(h, 0.0016f) * smoothStep(0.09f, 0.03f, h.y);
  };
  design.opening = [&f, size](const Vec3& p) {
    const Vec3 h = onHead(f, p);
    // The curtain falls from the parting in front of the ears; its tips turn in under the jaw.
    const float side = std::abs(h.x);
    const float face =
        h.z - (0.032f + 0.70f * std::max(h.y - 0.020f, 0.0f)) - 0.12f * std::max(0.05f - side, 0.0f);
    const float throat = std::min(h.z + 0.030f, 0.055f - side + 0.0f * h.y);
    return size *
           std::max({face, -0.118f - h.y + 0.25f * std::max(h.z, 0.0f), h.y < -0.02f ? throat : -1.0f});
  };
  design.face_count = 1200;
  return design;
}

GarmentDesign designBun(const Figure& f, const Palette& palette) {
  GarmentDesign design = startHair(f, "hair.bun", palette);
  const float size = f.head_size;
  SolidGroup hair;
  hair.join(skullShell(f, {0.0f, 0.010f, -0.011f}, {0.0815f, 0.0955f, 0.1035f}), 0.0f);
  joinForehead(hair, f);
  SolidGroup knot;
  knot.join(skullShell(f, {0.0f, 0.072f, -0.100f}, {0.037f, 0.034f, 0.032f}), 0.0f);
  design.shell = [&f, hair, knot, size](const Vec3& p) {
    const Vec3 h = onHead(f, p);
    const float skull = hair.distance(p) - size * strands(h, 0.0009f);
    return smoothMin(skull, knot.distance(p), 0.010f * size);
  };
  design.opening = [&f, size, knot](const Vec3& p) {
    const Vec3 h = onHead(f, p);
    return std::min(size * std::max(hairline(h, -0.012f), napeLine(h, -0.066f)),
                    knot.distance(p) - 0.008f * size);
  };
  design.face_count = 900;
  return design;
}

GarmentDesign designPonytail(const Figure& f, const Palette& palette) {
  GarmentDesign design = startHair(f, "hair.ponytail", palette);
  design.materials.push_back(clothMaterial("hair.ponytail.tie", palette.second));
  const float size = f.head_size;
  SolidGroup hair;
  hair.join(skullShell(f, {0.0f, 0.010f, -0.011f}, {0.0825f, 0.0960f, 0.1040f}), 0.0f);
  joinForehead(hair, f);
  const auto at = [&f](float y, float z) { return fromHead(f, Vec3(0.0f, y, z)); };
  SolidGroup tail;
  tail.join(Solid::roundCone(at(0.052f, -0.110f), at(0.062f, -0.140f), 0.018f * size, 0.020f * size), 0.0f);
  tail.join(Solid::roundCone(at(0.060f, -0.142f), at(-0.010f, -0.178f), 0.021f * size, 0.032f * size),
            0.02f * size);
  tail.join(Solid::roundCone(at(-0.010f, -0.178f), at(-0.100f, -0.170f), 0.031f * size, 0.026f * size),
            0.02f * size);
  tail.join(Solid::roundCone(at(-0.100f, -0.170f), at(-0.185f, -0.150f), 0.025f * size, 0.006f * size),
            0.02f * size);
  design.shell = [&f, hair, tail, size](const Vec3& p) {
    const Vec3 h = onHead(f, p);
    const float grooves = size * strands(h, 0.0010f);
    return smoothMin(hair.distance(p) - grooves, tail.distance(p) - grooves, 0.008f * size);
  };
  design.opening = [&f, size, tail](const Vec3& p) {
    const Vec3 h = onHead(f, p);
    return std::min(size * std::max(hairline(h, -0.012f), napeLine(h, -0.066f)),
                    tail.distance(p) - 0.008f * size);
  };
  const Field tie = [&f, size](const Vec3& p) {
    const Vec3 h = onHead(f, p);
    return size * (0.010f - std::abs(glm::dot(h - Vec3(0.0f, 0.057f, -0.124f),
                                              glm::normalize(Vec3(0.0f, 0.25f, -0.97f)))));
  };
  design.seams = {tie};
  design.label = [&f, tie](const Vec3& p) {
    return static_cast<std::uint8_t>(tie(p) > 0.0f && onHead(f, p).z < -0.108f && onHead(f, p).y > 0.03f ? 1
                                                                                                         : 0);
  };
  design.low = fromHead(f, Vec3(-0.16f, -0.22f, -0.25f));
  design.face_count = 1100;
  return design;
}

GarmentDesign designCap(const Figure& f, const Palette& palette) {
  GarmentDesign design = startHair(f, "cloth.cap", palette);
  design.materials.push_back(clothMaterial("cloth.cap.visor", palette.second));
  const float size = f.head_size;
  SolidGroup dome;
  dome.join(skullShell(f, {0.0f, 0.026f, -0.006f}, {0.0925f, 0.1015f, 0.1130f}), 0.0f);
  SolidGroup visor;
  const Mat3 tilt = Mat3(glm::mat3_cast(glm::angleAxis(radians(12.0f), Vec3(1, 0, 0))));
  visor.join(
      Solid::ellipsoid(fromHead(f, Vec3(0.0f, 0.033f, 0.098f)), Vec3(0.079f, 0.0075f, 0.090f) * size, tilt),
      0.0f);
  const auto edge = [&f, size](const Vec3& p) {
    const Vec3 h = onHead(f, p);
    return size * (0.030f + 0.10f * h.z - h.y);
  };
  design.shell = [dome, visor, edge, size](const Vec3& p) {
    return smoothMin(dome.distance(p), visor.distance(p), 0.006f * size);
  };
  design.opening = [edge, visor, size](const Vec3& p) {
    return std::min(edge(p), visor.distance(p) - 0.002f * size);
  };
  const Field rim = [dome, size](const Vec3& p) { return dome.distance(p) - 0.003f * size; };
  design.seams = {rim};
  design.label = [rim](const Vec3& p) { return static_cast<std::uint8_t>(rim(p) > 0.0f ? 1 : 0); };
  design.cell = 0.003f;
  design.hem = 0.006f;
  design.face_count = 700;
  return design;
}

}  // namespace ensemble
