// `ensemble people`: template people made from a few parameters, by our own code, and dressed by our recipes.
//
// A template has a node `body` with the six regions as materials (head, hands, feet, arms, torso, legs), one
// skin, metres, +Y up, facing +Z, bare soles at y = 0, right side at -X. Outfits are as authorOutfit makes
// them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "assetpipe/author_outfit.h"
#include "assetpipe/field_mesher.h"
#include "assetpipe/people_figure.h"
#include "assetpipe/people_skin.h"
#include "core/raw_asset.h"

namespace ensemble {

/// One person to make.
struct PersonConfig {
  std::string name;  ///< its folder's name
  FigureOptions figure;
  std::uint64_t seed = 0;  ///< of the colours of skin and hair
  PersonColors colors;
  std::vector<std::string> outfits;  ///< builtInRecipeNames(), in the order they are made; empty: all
  std::uint32_t body_faces = 3400;   ///< about so many triangles, 1500 .. 20000
};

struct PeopleConfig {
  std::vector<PersonConfig> people;  ///< at least one, names distinct
};

/// What a recipe made of a person's template.
struct MadeOutfit {
  Recipe recipe;
  AuthoredOutfit outfit;
};

struct MadePerson {
  std::string name;
  RawAsset body;  ///< the template: body, skeleton, clips
  std::vector<MadeOutfit> outfits;
  float walk_speed = 0.0f, run_speed = 0.0f;  ///< of `walk` and `run` over the ground, metres a second
};

/// Reads a configuration (docs/people.md). @throws InputError FILE: LINE:COLUMN: ...
PeopleConfig loadPeopleConfig(const std::filesystem::path& file);
PeopleConfig parsePeopleConfig(const std::string& text, const std::filesystem::path& file);

/// Makes a person in memory; takes a second or two, and about one for each outfit, of `jobs` threads (0: one
/// a core). The same configuration gives the same bytes. Outfits are those that `ensemble author` makes for
/// the template; hair has the person's colour. @throws InputError for a body that cuts itself.
/// @pre the configuration is as loadPeopleConfig returns it.
MadePerson makePerson(const PersonConfig& config, unsigned jobs = 0);

/// Refuses a body whose faces cut each other (makeBodyMesh tells when that happens).
/// @pre the mesh is closed @throws InputError person 'NAME': ...
void requireSoundBody(const std::string& person, const FieldMesh& mesh);

/// Only the template, as MadePerson::body has it.
RawAsset makeTemplatePerson(const PersonConfig& config);

/// Writes DIR/NAME/template.glb and DIR/NAME/outfits/OUTFIT.glb, each file whole or not at all; returns their
/// paths. @throws SystemError
std::vector<std::filesystem::path> writePerson(const MadePerson& person, const std::filesystem::path& folder);

}  // namespace ensemble
