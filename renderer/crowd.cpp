#include "renderer/crowd.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "core/check.h"
#include "core/log.h"
#include "core/nearest_name.h"
#include "core/random.h"
#include "renderer/animation.h"
#include "renderer/crowd_clothes.h"
#include "renderer/crowd_of_table.h"
#include "renderer/crowd_streams.h"
#include "renderer/crowd_walkers.h"
#include "renderer/placement.h"
#include "renderer/scene_names.h"
#include "renderer/weighted_choice.h"

namespace ensemble {
namespace {

/// What the crowd of one wardrobe wears and does.
struct WardrobeChoices {
  bool is_used = false;  ///< its weight is above 0
  std::vector<std::uint32_t> clips;
  WeightedChoice clip;
  std::optional<std::uint32_t> idle;       ///< where people walk: what they stand with
  std::vector<std::uint32_t> walk_styles;  ///< where people walk: for each of `clips`
};

/// The first clip of a template that moves it over the ground, or does not.
std::optional<std::uint32_t> firstClip(const TemplateBody& body, bool moves) {
  for (std::uint32_t i = 0; i < body.clips.size(); ++i) {
    if ((body.clips[i].ground_speed > 0.0f) == moves) return i;
  }
  return std::nullopt;
}

class CrowdBuilder {
 public:
  CrowdBuilder(const Scene& scene, std::span<const Wardrobe> wardrobes)
      : scene_(scene),
        wardrobes_(wardrobes),
        names_(scene, wardrobes),
        clothes_(scene, wardrobes, names_),
        choices_(wardrobes.size()) {}

  Crowd build() {
    if (scene_.crowd.placement.kind == PlacementKind::kTable) table_.emplace(scene_, wardrobes_);
    weighWardrobes();
    weighClothes();
    weighClips();
    addPeople();
    addCrowd();
    internCombinations();
    return std::move(crowd_);
  }

 private:
  void weighWardrobes() {
    std::vector<float> weights(wardrobes_.size(), scene_.crowd.wardrobes.empty() ? 1.0f : 0.0f);
    for (const WeightedName& named : scene_.crowd.wardrobes) {
      weights[names_.wardrobe(named.name, named.mark)] = named.weight;
    }
    for (std::size_t w = 0; w < weights.size(); ++w) {
      wardrobe_.add(weights[w]);
      choices_[w].is_used = table_ && table_->tellsWardrobes() ? table_->uses(static_cast<std::uint32_t>(w))
                                                               : weights[w] > 0.0f;
    }
    ENSEMBLE_CHECK(wardrobe_.total() > 0.0);  // parseScene refuses weights that are all 0
  }

  /// Nobody of the crowd need be dressed where a table tells what they wear, or where there is nobody.
  void weighClothes() {
    const bool is_needed = scene_.crowd.count != 0u && !(table_ && table_->tellsOutfits());
    std::vector<bool> is_used;
    for (const WardrobeChoices& choices : choices_) is_used.push_back(choices.is_used && is_needed);
    clothes_.weigh(is_used);
  }

  bool walks() const {
    return scene_.crowd.placement.kind == PlacementKind::kPaths ||
           scene_.crowd.placement.kind == PlacementKind::kFile;
  }

  void weighClips() {
    for (std::uint32_t w = 0; w < choices_.size(); ++w) {
      WardrobeChoices& choices = choices_[w];
      // A wardrobe that nobody of the crowd is dressed from needn't have the clips.
      if (!choices.is_used) continue;
      for (const WeightedName& named : scene_.crowd.clips) {
        choices.clips.push_back(names_.clipOf(w, named.name, named.mark));
        choices.clip.add(named.weight);
        if (walks() && !(wardrobes_[w].body.clips[choices.clips.back()].ground_speed > 0.0f)) {
          names_.fail(named.mark,
                      fmt::format("the clip {} stands still, and people walk here", quotedName(named.name)),
                      "name clips that walk; what people stand with is crowd.placement.idle");
        }
      }
      if (choices.clips.empty()) {
        choices.clips.push_back(walks() ? firstWalk(w) : 0);
        choices.clip.add(1.0f);
      }
      ENSEMBLE_CHECK(choices.clip.total() > 0.0);
      if (walks()) addWalkStyles(w, choices);
    }
  }

  std::uint32_t firstWalk(std::uint32_t wardrobe) const {
    const std::optional<std::uint32_t> walk = firstClip(wardrobes_[wardrobe].body, true);
    if (walk) return *walk;
    names_.fail({0, 0, "crowd.placement"},
                fmt::format("people walk here, but {} has no clip that walks", names_.describe(wardrobe)),
                "tag the template with a walking clip, or place the crowd on a grid");
  }

  void addWalkStyles(std::uint32_t wardrobe, WardrobeChoices& choices) {
    const SceneWalking& walking = scene_.crowd.placement.walking;
    choices.idle = firstClip(wardrobes_[wardrobe].body, false);
    if (!walking.idle.value.empty()) {
      choices.idle = names_.clipOf(wardrobe, walking.idle.value, walking.idle.mark);
    }
    for (const std::uint32_t clip : choices.clips) {
      choices.walk_styles.push_back(static_cast<std::uint32_t>(crowd_.walk_styles.size()));
      crowd_.walk_styles.push_back(
          makeWalkStyle(wardrobes_[wardrobe].body, clip, choices.idle, walking.idle_below));
    }
  }

  void addPeople() {
    const RandomStream tints(scene_.crowd.seed, crowd_stream::kPersonTint);
    for (std::size_t i = 0; i < scene_.people.size(); ++i) {
      const ScenePerson& person = scene_.people[i];
      Character character;
      character.wardrobe = names_.wardrobeOrOnly(
          {person.wardrobe.value, person.wardrobe.value.empty() ? person.mark : person.wardrobe.mark},
          fmt::format("people.{}", i), "add 'wardrobe:' with");
      character.combination =
          addWorn({character.wardrobe,
                   person.wears.empty()
                       ? names_.combinationOf(character.wardrobe, person.outfit.value, person.outfit.mark)
                       : names_.combinationOf(character.wardrobe, person.wears)});
      if (!person.clip.value.empty()) {
        character.clip = names_.clipOf(character.wardrobe, person.clip.value, person.clip.mark);
      }
      character.phase = person.phase;
      character.speed = person.speed;
      character.position = person.position;
      character.heading = person.heading;
      character.scale = person.scale;
      character.tint_seed = person.tint.value_or(tints.bits32(i));
      crowd_.characters.push_back(character);
    }
  }

  void addCrowd() {
    const SceneCrowd& crowd = scene_.crowd;
    if (table_) {
      for (const WornCombination& worn : table_->worn()) worn_of_table_.push_back(addWorn(worn));
    }
    const std::uint64_t seed = crowd.seed;
    const RandomStream wardrobes(seed, crowd_stream::kWardrobe), clips(seed, crowd_stream::kClip),
        phases(seed, crowd_stream::kPhase), scales(seed, crowd_stream::kScale),
        tints(seed, crowd_stream::kTint);
    const std::uint32_t count = walks() ? setOut() : table_ ? table_->count() : *crowd.count;
    const std::vector<Place> places = walks() ? std::vector<Place>() : place(count);
    crowd_.characters.reserve(crowd_.characters.size() + count);
    for (std::uint32_t i = 0; i < count; ++i) {
      Character character;
      character.wardrobe = table_ && table_->tellsWardrobes()
                               ? table_->wardrobe(i)
                               : static_cast<std::uint32_t>(wardrobe_.choose(wardrobes.uniform(i)));
      const WardrobeChoices& choices = choices_[character.wardrobe];
      const std::size_t clip = choices.clip.choose(clips.uniform(i));
      character.clip = choices.clips[clip];
      character.phase = phases.uniformFloat(i);
      character.scale = std::min(crowd.scale[0] + (crowd.scale[1] - crowd.scale[0]) * scales.uniformFloat(i),
                                 crowd.scale[1]);
      character.tint_seed = tints.bits32(i);
      if (walks()) {
        startWalking(i, choices.walk_styles[clip], character);
      } else {
        character.position = places[i].position;
        character.heading = places[i].heading;
      }
      if (table_ && table_->tellsOutfits()) {
        character.combination = worn_of_table_[table_->outfit(i)];
      } else {
        character.combination = addWorn({character.wardrobe, clothes_.of(character.wardrobe, i)});
      }
      if (table_) table_->tell(i, character);
      crowd_.characters.push_back(character);
    }
  }

  std::vector<Place> place(std::uint32_t count) const {
    const SceneCrowd& crowd = scene_.crowd;
    try {
      return placePeople(crowd.placement, count, crowd.seed);
    } catch (const std::length_error&) {
      names_.fail({0, 0, "crowd.placement"},
                  fmt::format("positions are too coarse for a spacing of {} this far from the origin",
                              crowd.placement.spacing),
                  "move crowd.placement.center nearer to [0, 0, 0], or raise the spacing");
    }
  }

  /// Journeys and walkers of the crowd; returns how many people they are.
  std::uint32_t setOut() {
    CrowdWalkers walkers =
        scene_.crowd.placement.kind == PlacementKind::kPaths ? walkersOnPaths() : walkersOfFile();
    crowd_.journeys = std::move(walkers.journeys);
    crowd_.walkers = std::move(walkers.walkers);
    return static_cast<std::uint32_t>(crowd_.walkers.size());
  }

  CrowdWalkers walkersOnPaths() const {
    // All of a lane go at one speed, whoever they are.
    double speeds = 0.0, count = 0.0;
    for (std::size_t w = 0; w < choices_.size(); ++w) {
      for (const std::uint32_t clip : choices_[w].clips) {
        speeds += double{wardrobes_[w].body.clips[clip].ground_speed};
        ++count;
      }
    }
    try {
      return placeOnPaths(scene_.crowd.placement, *scene_.crowd.count, scene_.crowd.seed,
                          static_cast<float>(speeds / count));
    } catch (const PathProblem& problem) {
      names_.fail(problem.mark, problem.what, problem.mend);
    }
  }

  CrowdWalkers walkersOfFile() const {
    const ScenePlacement& placement = scene_.crowd.placement;
    Trajectories trajectories = loadTrajectories(placement.file.value);
    for (const std::string& warning : trajectories.warnings) logWarning(warning);
    const float fps = placement.walking.fps.value_or(trajectories.fps);
    if (!(fps > 0.0f)) {
      names_.fail(placement.file.mark,
                  fmt::format("{} does not tell its frames a second", placement.file.value.string()),
                  "add 'fps:' beside 'file:'");
    }
    if (scene_.crowd.count) {
      if (*scene_.crowd.count > trajectories.people.size()) {
        names_.fail({0, 0, "crowd.count"},
                    fmt::format("{} people, but {} has {}", *scene_.crowd.count,
                                placement.file.value.string(), trajectories.people.size()),
                    "lower crowd.count, or leave it out to have all");
      }
      trajectories.people.resize(*scene_.crowd.count);
    }
    return followTrajectories(trajectories, fps, placement);
  }

  void startWalking(std::uint32_t number, std::uint32_t style, Character& character) {
    Walker& walker = crowd_.walkers[number];
    walker.style = style;
    walker.phase = character.phase;
    walker.first_foot = RandomStream(scene_.crowd.seed, crowd_stream::kFirstFoot).bits32(number) & 1u;
    character.walker = number;
    const CharacterPose pose = poseAt(crowd_, character, 1.0f, 0.0);
    character.position = pose.position;
    character.heading = pose.heading;
    character.phase = pose.phase;
  }

  /// Numbers combinations as they come, equal ones alike.
  std::uint32_t addWorn(WornCombination worn) {
    const auto [entry, is_new] =
        number_of_worn_.try_emplace(std::move(worn), static_cast<std::uint32_t>(number_of_worn_.size()));
    return entry->second;
  }

  /// Numbers combinations anew, by wardrobe and items, without those of a table that nobody wears.
  void internCombinations() {
    std::vector<std::uint8_t> is_worn(number_of_worn_.size(), 0);
    for (const Character& character : crowd_.characters) is_worn[character.combination] = 1;
    std::vector<std::uint32_t> renumbered(number_of_worn_.size(), 0);
    for (const auto& [worn, number] : number_of_worn_) {
      if (is_worn[number] == 0) continue;
      renumbered[number] = static_cast<std::uint32_t>(crowd_.combinations.size());
      crowd_.combinations.push_back(worn);
    }
    for (Character& character : crowd_.characters) character.combination = renumbered[character.combination];
  }

  const Scene& scene_;
  std::span<const Wardrobe> wardrobes_;
  SceneNames names_;
  std::optional<CrowdOfTable> table_;  ///< where the crowd comes from one
  CrowdClothes clothes_;
  WeightedChoice wardrobe_;
  std::vector<WardrobeChoices> choices_;
  std::map<WornCombination, std::uint32_t> number_of_worn_;
  std::vector<std::uint32_t> worn_of_table_;
  Crowd crowd_;
};

}  // namespace

Mat4 Character::worldFromModel() const {
  const float sine = std::sin(heading) * scale, cosine = std::cos(heading) * scale;
  return Mat4(Vec4(cosine, 0.0f, -sine, 0.0f), Vec4(0.0f, scale, 0.0f, 0.0f), Vec4(sine, 0.0f, cosine, 0.0f),
              Vec4(position, 1.0f));
}

CharacterPose poseAt(const Crowd& crowd, const Character& character, float clip_seconds, double seconds,
                     FeetOf feet) {
  CharacterPose pose;
  Character now = character;
  pose.clip = pose.idle_clip = character.clip;
  if (!character.walker) {
    pose.phase = phaseAt(seconds, clip_seconds, character.phase, character.speed);
  } else {
    const Walker& walker = crowd.walkers[*character.walker];
    const WalkStyle& style = crowd.walk_styles[walker.style];
    const WalkerPose walked =
        walkAt(walker, crowd.journeys[walker.journey], style, character.scale, seconds, feet);
    now.position = walked.position;
    now.heading = walked.heading;
    pose.phase = walked.walk_phase;
    pose.idle_clip = style.idle_clip.value_or(character.clip);
    pose.idle_phase = walked.idle_phase;
    pose.idle_weight = walked.idle_weight;
    pose.holds_feet = walked.holds_feet;
    pose.feet = walked.feet;
    pose.exists = walked.exists;
  }
  pose.position = now.position;
  pose.heading = now.heading;
  pose.world_from_model = now.worldFromModel();
  return pose;
}

Crowd populateCrowd(const Scene& scene, std::span<const Wardrobe> wardrobes) {
  return CrowdBuilder(scene, wardrobes).build();
}

}  // namespace ensemble
