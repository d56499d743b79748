// A recipe of clothes (`ensemble author`, docs/authoring.md), as its file says it.
//
// Lengths are in metres of a body 1.75 m tall and scale with the body. Heights are *levels*: 2 the top of
// the head, 1 the neck's base, 0 the hip joints, -1 the knees, -2 the ankles, -3 the ground. Places on an
// arm: 0 the shoulder, 1 the elbow, 2 the wrist.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/math.h"
#include "core/slots.h"
#include "core/source_mark.h"

namespace ensemble {

/// A length that changes along a limb: linear between its pairs of place and length, constant beyond.
struct Profile {
  std::vector<std::pair<float, float>> points;  ///< places ascending
  float at(float place) const;
};

struct Interval {
  float from = 0.0f, to = 0.0f;
};

enum class PatternKind : std::uint8_t { kNone, kStripes, kPinstripes, kChecks, kDots, kKnit };

struct Pattern {
  PatternKind kind = PatternKind::kNone;
  Vec3 color{0.0f};    ///< sRGB of the second colour
  float size = 0.06f;  ///< of one repeat
};

/// A simple solid that is joined with the cloth, or that cuts it.
struct SolidRecipe {
  enum class Shape : std::uint8_t { kEllipsoid, kCone, kDisc };
  enum class Frame : std::uint8_t { kHead, kNeck, kFoot };
  Shape shape = Shape::kEllipsoid;
  Frame frame = Frame::kHead;
  Vec3 center{0.0f}, radii{0.03f};  ///< kEllipsoid; kDisc: radii.y is half its thickness
  float tilt_degrees = 0.0f;        ///< kEllipsoid, kDisc: about X, front down
  Vec3 from{0.0f}, to{0.0f};        ///< kCone: two round ends ...
  std::array<float, 2> ends{};      ///< ... and their radii
  bool both_sides = false;          ///< and its mirror image
  float blend = 0.01f;
};

/// A part of the cloth in a colour of its own, raised a little. Where several places are given it is where
/// they overlap.
struct TrimRecipe {
  std::string material;  ///< first word of its material's name; empty: the garment's
  std::string name,
      of;  ///< of: along that opening ("hem", "top", "neck", "sleeves", "front", "edge"), or empty
  float width = 0.03f;                         ///< along an opening
  std::optional<Interval> level, arm, across;  ///< across: from the middle to the left, metres
  std::string side;                            ///< "front", "back", "outside" or empty: all around
  float slant = 0.0f;                          ///< of `across`: metres further out for each metre up
  float raise = 0.0f;
  Vec3 color{0.5f};  ///< sRGB
  SourceMark mark;
};

struct NeckRecipe {
  float rise = 0.0f, width = 0.075f;  ///< of its edge over the neck's base; its radius
  float drop = 0.0f;                  ///< a scoop to the front, so deep
  float vee = 0.0f;                   ///< a V to the front, so deep
};

struct DrapeRecipe {
  float from = 1.0f;  ///< level
  float ease = 0.01f;
  float cling = 0.0f;  ///< how fast it may fall back to the body, metres a metre; 0: it hangs straight
  float flare = 0.0f;  ///< metres wider for each metre further down
  float folds = 0.0f;  ///< depth at the hem
  std::uint32_t fold_count = 9;
};

struct FrontRecipe {
  Interval level;              ///< of the opening
  Interval width{0.0f, 0.0f};  ///< half its width at both ends
};

struct SoleRecipe {
  float thickness = 0.015f, rise = 0.012f, out = 0.006f, heel = 0.0f;
};

struct HairRecipe {
  float front = 0.050f, sideburn = -0.030f, nape = -0.070f;  ///< heights over the line between the ears
  bool curtain = false;  ///< falls in front of the ears and below the nape
  float length = 0.12f;  ///< of a curtain, below the line between the ears
};

enum class GarmentKind : std::uint8_t { kBody, kShoes, kHead };

struct GarmentRecipe {
  std::string name;
  GarmentKind kind = GarmentKind::kBody;
  std::string material = "cloth";  ///< first word of its materials' names; "fixed": tints leave it alone
  std::uint32_t triangles = 1000;
  Vec3 color{0.5f};  ///< sRGB
  Pattern pattern;
  std::filesystem::path texture;  ///< PNG or JPEG, beside the recipe; empty: none
  float texture_size = 0.2f;
  float thickness = 0.005f;  ///< how far edges are turned in
  std::vector<TrimRecipe> trims;
  std::vector<SolidRecipe> solids, cuts;
  std::optional<Marked<std::string>> avoid;   ///< a region of the template that stays bare
  std::optional<Marked<std::string>> attach;  ///< the joint that alone moves it

  Profile ease{{{0.0f, 0.010f}}};  ///< over torso and head, by level
  // Kind body.
  std::optional<float> top, armhole;
  std::optional<NeckRecipe> neck;
  float hem = 0.0f, hem_rise = 0.0f;  ///< level; metres that it is higher in front than at the back
  std::optional<Interval> sleeves;    ///< to: place on the arm; from: unused
  Profile sleeve_ease{{{0.0f, 0.010f}}}, leg_ease{{{0.0f, 0.010f}}};  ///< by place on the arm; by level
  std::optional<DrapeRecipe> drape;
  std::optional<FrontRecipe> front;
  float hang = 0.0f;  ///< 0: moves as the skin below it .. 1: swings as a wide skirt
  // Kind shoes.
  float height = 0.085f,
        slope = 0.0f;  ///< of the shaft over the ground; its fall to the front, metres a metre
  SoleRecipe sole;
  std::vector<Interval> straps;  ///< places along the foot, 0 heel .. 1 toe; empty: closed
  // Kind head.
  std::optional<HairRecipe> hair;
  float edge = 0.030f,
        edge_slope = 0.1f;  ///< a hat's: height over the line between the ears; rise to the front
  float strands = 0.0f;     ///< depth of the grooves of combed hair
  SourceMark mark;
};

struct Recipe {
  std::filesystem::path file;
  std::string name;
  Slot slot = Slot::kFull;
  int layer = 0;
  std::map<std::string, std::string> joints;  ///< landmark -> joint, for skeletons with names of their own
  std::map<std::string, SourceMark> joint_marks;
  std::vector<GarmentRecipe> garments;  ///< at least one, names distinct
};

/// Reads a recipe: strictly, then against outfits/schema/recipe.schema.json.
/// @throws InputError FILE: LINE:COLUMN: ...
Recipe loadRecipe(const std::filesystem::path& file);
Recipe parseRecipe(const std::string& text, const std::filesystem::path& file);

}  // namespace ensemble
