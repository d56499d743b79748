// Skull, face and neck. Points are those of a head of reference size, from between the ears: y up, z to the
// front; the face's plane lies at about z = 0.09, brows at y = 0.012, mouth at y = -0.083.
#include <algorithm>
#include <cmath>

#include "assetpipe/people_builder.h"

namespace ensemble {

Vec3 FigureBuilder::fromHead(float x, float y, float z) const {
  const float top = m_.height - 0.100f * m_.head_size;
  return Vec3(0.0f, top, 0.0f) + Vec3(x, y, z) * m_.head_size;
}

void FigureBuilder::buildHead() {
  SolidGroup& head = figure_.head_solids;
  const float jaw = (female_ ? 0.78f : 0.93f) * (figure_.options.age == AgeGroup::kYoung ? 0.94f : 1.0f);
  const float flesh = 1.0f + 0.10f * std::max(girth_, 0.0f);
  // Skull, forehead, and the block of the face.
  head.join(ball(fromHead(0, 0.009f, -0.012f), headSize(0.0755f, 0.0905f, 0.0970f)), 0.0f);
  head.join(ball(fromHead(0, 0.034f, 0.022f), headSize(0.0610f, 0.0600f, 0.0660f)), h(0.030f));
  head.join(ball(fromHead(0, -0.036f, 0.026f), headSize(0.0600f * (0.5f + 0.5f * jaw), 0.078f, 0.0665f)),
            h(0.030f));
  head.join(ball(fromHead(0, -0.086f, 0.036f), headSize(0.0410f * jaw, 0.036f, 0.0520f)), h(0.030f));
  const float under = old_ ? 0.002f : 0.0f;
  head.join(ball(fromHead(0, -0.1085f, 0.0780f), headSize(0.0200f * jaw, 0.0165f, 0.0165f)), h(0.020f));
  for (const float side : {1.0f, -1.0f}) {
    head.join(cone(fromHead(side * 0.0530f * jaw, -0.062f, 0.006f),
                   fromHead(side * 0.0180f * jaw, -0.1085f - under, 0.064f), 0.0165f * m_.head_size * flesh,
                   0.0155f * m_.head_size * flesh),
              h(0.025f));
    // Cheek bone and cheek.
    head.join(ball(fromHead(side * 0.0470f, -0.029f, 0.0560f), headSize(0.0200f, 0.0150f, 0.0240f)),
              h(0.026f));
    const float hollow = old_ ? 0.88f : 1.0f;
    head.join(ball(fromHead(side * 0.0350f, -0.064f, 0.0500f),
                   headSize(0.0230f * jaw * hollow * flesh, 0.032f, 0.0290f * hollow)),
              h(0.030f));
    buildFace(side);
  }
  buildNose();
  for (const float side : {1.0f, -1.0f}) {
    buildMouth(side);
    buildEar(side);
  }
  // The line between the lips.
  head.carve(ball(fromHead(0, -0.0832f, 0.1030f), headSize(0.0240f, 0.0015f, 0.0085f)), h(0.0030f));
  buildNeck();
}

void FigureBuilder::buildNeck() {
  SolidGroup& head = figure_.head_solids;
  const float neck = (female_ ? 0.0465f : 0.0575f) * (1.0f + 0.09f * girth_ + 0.05f * build_) *
                     (figure_.options.age == AgeGroup::kYoung ? 0.93f : 1.0f);
  const Solid column =
      cone(Vec3(0, m_.neck - 0.04f, -0.036f), fromHead(0, -0.06f, -0.016f), neck * 1.06f, neck * 0.98f);
  head.join(column, s(0.028f));
  figure_.neck_solids.join(column, 0.0f);
  // From behind the ear to the pit of the neck.
  const float pit = m_.neck - 0.044f;
  for (const float side : {1.0f, -1.0f}) {
    head.join(
        cone(fromHead(side * 0.046f, -0.058f, -0.020f), Vec3(side * 0.014f, pit, female_ ? 0.022f : 0.030f),
             0.0125f * (female_ ? 0.8f : 1.0f), 0.008f),
        s(0.022f));
  }
  if (!female_) head.join(ball(fromHead(0, -0.146f, 0.036f), headSize(0.010f, 0.016f, 0.012f)), h(0.018f));
}

void FigureBuilder::buildFace(float side) {
  SolidGroup& head = figure_.head_solids;
  const float soft = female_ || figure_.options.age == AgeGroup::kYoung ? 0.78f : 1.0f;
  const float r = m_.head_size;
  // Brow, the socket under it, the eye in it, and the lid that hangs over the eye.
  head.join(cone(fromHead(side * 0.0130f, 0.0125f, 0.0855f), fromHead(side * 0.0480f, 0.0135f, 0.0640f),
                 0.0095f * soft * r, 0.0085f * soft * r),
            h(0.018f));
  head.carve(ball(fromHead(side * 0.0325f, -0.0070f, 0.1040f), headSize(0.0215f, 0.0140f, 0.0205f)),
             h(0.014f));
  head.join(ball(fromHead(side * 0.0320f, -0.0075f, 0.0735f), headSize(0.0142f, 0.0128f, 0.0128f)),
            h(0.005f));
  head.join(cone(fromHead(side * 0.0215f, -0.0010f, 0.0815f), fromHead(side * 0.0440f, -0.0015f, 0.0755f),
                 0.0040f * r, 0.0036f * r),
            h(0.006f));
  head.join(cone(fromHead(side * 0.0230f, -0.0165f, 0.0790f), fromHead(side * 0.0420f, -0.0160f, 0.0735f),
                 0.0042f * r, 0.0036f * r),
            h(0.007f));
}

void FigureBuilder::buildNose() {
  SolidGroup& head = figure_.head_solids;
  const float r = m_.head_size * (female_ ? 0.90f : 1.0f) * (old_ ? 1.08f : 1.0f);
  head.join(cone(fromHead(0, 0.0010f, 0.0885f), fromHead(0, -0.0400f, 0.1085f), 0.0068f * r, 0.0092f * r),
            h(0.012f));
  head.join(ball(fromHead(0, -0.0440f, 0.1085f), headSize(0.0102f, 0.0092f, 0.0105f) * (old_ ? 1.08f : 1.0f)),
            h(0.008f));
  for (const float side : {1.0f, -1.0f}) {
    head.join(ball(fromHead(side * 0.0125f * (female_ ? 0.92f : 1.0f), -0.0480f, 0.0985f),
                   headSize(0.0072f, 0.0072f, 0.0095f)),
              h(0.006f));
  }
}

void FigureBuilder::buildMouth(float side) {
  SolidGroup& head = figure_.head_solids;
  const float full = (female_ ? 1.06f : 0.92f) * (old_ ? 0.82f : 1.0f), r = m_.head_size;
  // The swell of the teeth, then a bow above and one below.
  head.join(ball(fromHead(side * 0.010f, -0.0800f, 0.0780f), headSize(0.0230f, 0.0220f, 0.0190f)), h(0.020f));
  head.join(cone(fromHead(side * 0.0055f, -0.0770f, 0.0970f), fromHead(side * 0.0240f, -0.0825f, 0.0860f),
                 0.0064f * full * r, 0.0028f * r),
            h(0.006f));
  head.join(cone(fromHead(side * 0.0040f, -0.0896f, 0.0958f), fromHead(side * 0.0225f, -0.0842f, 0.0860f),
                 0.0074f * full * r, 0.0028f * r),
            h(0.006f));
}

void FigureBuilder::buildEar(float side) {
  SolidGroup& head = figure_.head_solids;
  const float big = old_ ? 1.10f : 1.0f;
  const auto place = [&](float out, float y, float z) { return fromHead(side * out, y, z); };
  const Mat3 turn = Mat3(glm::mat3_cast(glm::angleAxis(radians(side * -24.0f), Vec3(0, 1, 0)) *
                                        glm::angleAxis(radians(-12.0f), Vec3(1, 0, 0))));
  head.join(ball(place(0.0790f, -0.0125f, -0.0105f), headSize(0.0058f, 0.0280f, 0.0165f) * big, turn),
            h(0.006f));
  head.join(ball(place(0.0765f, -0.0390f, -0.0040f), headSize(0.0050f, 0.0095f, 0.0080f) * big, turn),
            h(0.006f));
  // The hollow within the rim.
  head.carve(ball(place(0.0865f, -0.0120f, -0.0040f), headSize(0.0060f, 0.0175f, 0.0085f) * big, turn),
             h(0.004f));
}

}  // namespace ensemble
