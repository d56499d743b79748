// Clothes and hair: designed as fields around a figure, made into meshes.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "assetpipe/people_body.h"

namespace ensemble {

/// A garment before it is meshed. Its fields refer to the figure, which must outlive the design.
struct GarmentDesign {
  std::string name;                                ///< "cloth.jeans"; the node is called garment.jeans
  std::vector<RawMaterial> materials;              ///< by label
  Field shell;                                     ///< the outside of the cloth, openings closed
  Field opening;                                   ///< negative where there is cloth, metres to its edges
  std::function<std::uint8_t(const Vec3&)> label;  ///< material of a point; unset: 0
  std::vector<Field> seams;                        ///< zero along the lines between labels
  std::function<SkinBinding(const Vec3&)> binding;
  std::function<float(const Vec3&)> importance;  ///< for the simplification; unset: 1
  Vec3 low{0.0f}, high{0.0f};                    ///< box that holds it
  float cell = 0.006f;                           ///< of the grid it is meshed on, metres
  float hem = 0.005f;                            ///< how far the edges are turned in, metres
  float cover_margin = 0.02f;                    ///< skin nearer than this to an edge shows, metres
  bool covers_skin = true;                       ///< false: hides no skin (hair)
  bool symmetric = true;                         ///< half is made and mirrored
  std::size_t face_count = 1000;                 ///< wanted, before the mirror image: both halves together
};

/// A garment as it stands in every outfit that has it.
struct MadeGarment {
  RawMeshNode node;  ///< `material` indexes `materials`
  std::vector<RawMaterial> materials;
  /// How well skin at a point is covered: 0 where no cloth lies over it, 1 at `cover_margin` from the
  /// edges, more further in; unset: it hides nothing.
  Field cover;
};

/// Meshes a design: the outside, cut at its openings, with the edges turned in towards the skin.
MadeGarment makeGarment(const Figure& figure, const GarmentDesign& design);

/// Which faces of the body can be left out under some garments, #F.
std::vector<std::uint8_t> findCoveredFaces(const FieldMesh& body,
                                           const std::vector<const MadeGarment*>& garments);

/// Linear base colours.
struct Palette {
  Vec3 main{0.5f}, second{0.5f};
};

RawMaterial clothMaterial(const std::string& name, const Vec3& linear_color);

/// The designs. What `second` colours is told per design.
GarmentDesign designTshirt(const Figure& figure, const Palette& palette);
GarmentDesign designShirt(const Figure& figure, const Palette& palette);  // second: tie
GarmentDesign designBlouse(const Figure& figure, const Palette& palette);
GarmentDesign designHoodie(const Figure& figure, const Palette& palette);    // second: cuffs and hem
GarmentDesign designJacket(const Figure& figure, const Palette& palette);    // second: lapels
GarmentDesign designDress(const Figure& figure, const Palette& palette);     // second: belt
GarmentDesign designJeans(const Figure& figure, const Palette& palette);     // second: belt
GarmentDesign designTrousers(const Figure& figure, const Palette& palette);  // second: belt
GarmentDesign designShorts(const Figure& figure, const Palette& palette);    // second: side stripes
GarmentDesign designLeggings(const Figure& figure, const Palette& palette);  // second: side stripes
GarmentDesign designSkirt(const Figure& figure, const Palette& palette);
GarmentDesign designSneakers(const Figure& figure, const Palette& palette);  // second: sole
GarmentDesign designOxfords(const Figure& figure, const Palette& palette);   // second: sole
GarmentDesign designFlats(const Figure& figure, const Palette& palette);     // second: sole
GarmentDesign designShortHair(const Figure& figure, const Palette& palette);
GarmentDesign designBob(const Figure& figure, const Palette& palette);
GarmentDesign designBun(const Figure& figure, const Palette& palette);
GarmentDesign designPonytail(const Figure& figure, const Palette& palette);  // second: hair tie
GarmentDesign designCap(const Figure& figure, const Palette& palette);       // second: visor

}  // namespace ensemble
