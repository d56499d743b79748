#include "renderer/crowd.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/check.h"
#include "core/log.h"
#include "core/nearest_name.h"
#include "core/random.h"
#include "renderer/animation.h"
#include "renderer/crowd_of_table.h"
#include "renderer/crowd_streams.h"
#include "renderer/crowd_walkers.h"
#include "renderer/placement.h"
#include "renderer/scene_names.h"

namespace ensemble {
namespace {

/// Chooses a number with a probability in proportion to its weight; one of weight 0 never.
class WeightedChoice {
 public:
  void add(float weight) {
    sums_.push_back(total() + static_cast<double>(weight));
    if (weight > 0.0f) last_possible_ = sums_.size() - 1;
  }
  double total() const { return sums_.empty() ? 0.0 : sums_.back(); }
  std::size_t size() const { return sums_.size(); }

  /// @param u in [0, 1). @pre total() > 0
  std::size_t choose(double u) const {
    // The first sum beyond u: an entry of weight 0 has the sum of the one before it.
    const auto found = std::upper_bound(sums_.begin(), sums_.end(), u * total());
    return std::min(static_cast<std::size_t>(found - sums_.begin()), last_possible_);
  }

 private:
  std::vector<double> sums_;
  std::size_t last_possible_ = 0;
};

/// What the crowd of one wardrobe wears and does.
struct WardrobeChoices {
  bool is_used = false;  ///< its weight is above 0
  std::vector<Combination> outfits;
  WeightedChoice outfit;
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
      : scene_(scene), wardrobes_(wardrobes), names_(scene, wardrobes), choices_(wardrobes.size()) {}

  Crowd build() {
    if (scene_.crowd.placement.kind == PlacementKind::kTable) table_.emplace(scene_, wardrobes_);
    weighWardrobes();
    weighOutfits();
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

  void weighOutfits() {
    if (scene_.crowd.outfits.empty()) {
      for (std::size_t w = 0; w < wardrobes_.size(); ++w) weighAllOutfits(w);
      return;
    }
    for (const WeightedName& named : scene_.crowd.outfits) {
      const FoundOutfit found = names_.outfit(named.name, named.mark);
      WardrobeChoices& choices = choices_[found.wardrobe];
      const Combination combination{found.item};
      if (std::find(choices.outfits.begin(), choices.outfits.end(), combination) != choices.outfits.end()) {
        names_.fail(named.mark, fmt::format("the outfit {} is here a second time", quotedName(named.name)),
                    "remove one of them");
      }
      choices.outfits.push_back(combination);
      choices.outfit.add(named.weight);
    }
    for (std::uint32_t w = 0; w < choices_.size(); ++w) {
      if (!choices_[w].is_used || choices_[w].outfit.total() > 0.0) continue;
      names_.fail(scene_.crowd.outfits.front().mark,
                  fmt::format("crowd.outfits has nothing to wear for {}", names_.describe(w)),
                  "list an outfit of it with a weight above 0, or give the wardrobe the weight 0 in "
                  "crowd.wardrobes");
    }
  }

  /// Every complete outfit alike; single pieces only where there is nothing else.
  void weighAllOutfits(std::size_t wardrobe) {
    const PerItem<Item>& items = wardrobes_[wardrobe].items;
    WardrobeChoices& choices = choices_[wardrobe];
    const auto is_full = [](const Item& item) { return item.slot == "full"; };
    const bool has_full = std::any_of(items.begin(), items.end(), is_full);
    for (std::size_t i = 0; i < items.size(); ++i) {
      if (has_full && !is_full(items[ItemId(i)])) continue;
      choices.outfits.push_back({ItemId(i)});
    }
    if (items.empty()) choices.outfits.push_back({});
    for (std::size_t i = 0; i < choices.outfits.size(); ++i) choices.outfit.add(1.0f);
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
      Combination items;
      if (!person.outfit.value.empty()) {
        items.push_back(names_.outfitOf(character.wardrobe, person.outfit.value, person.outfit.mark));
      }
      character.combination = addWorn({character.wardrobe, std::move(items)});
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
    const std::vector<std::uint32_t> first_worn = addAllWorn();
    const std::uint64_t seed = crowd.seed;
    const RandomStream wardrobes(seed, crowd_stream::kWardrobe), outfits(seed, crowd_stream::kOutfit),
        clips(seed, crowd_stream::kClip), phases(seed, crowd_stream::kPhase),
        scales(seed, crowd_stream::kScale), tints(seed, crowd_stream::kTint);
    const std::uint32_t count = walks() ? setOut() : table_ ? table_->count() : *crowd.count;
    const std::vector<Place> places = walks() ? std::vector<Place>() : place(count);
    crowd_.characters.reserve(crowd_.characters.size() + count);
    for (std::uint32_t i = 0; i < count; ++i) {
      Character character;
      character.wardrobe = table_ && table_->tellsWardrobes()
                               ? table_->wardrobe(i)
                               : static_cast<std::uint32_t>(wardrobe_.choose(wardrobes.uniform(i)));
      const WardrobeChoices& choices = choices_[character.wardrobe];
      character.combination = first_worn[character.wardrobe] +
                              static_cast<std::uint32_t>(choices.outfit.choose(outfits.uniform(i)));
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
      if (table_) table_->tell(i, first_worn.back(), character);
      crowd_.characters.push_back(character);
    }
  }

  /// What the crowd may wear. Per wardrobe: its first outfit in worn_; and last: the table's first.
  std::vector<std::uint32_t> addAllWorn() {
    std::vector<std::uint32_t> first_worn;
    for (std::uint32_t w = 0; w < choices_.size(); ++w) {
      first_worn.push_back(static_cast<std::uint32_t>(worn_.size()));
      for (const Combination& items : choices_[w].outfits) worn_.push_back({w, items});
    }
    first_worn.push_back(static_cast<std::uint32_t>(worn_.size()));
    if (table_) worn_.insert(worn_.end(), table_->worn().begin(), table_->worn().end());
    return first_worn;
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

  std::uint32_t addWorn(WornCombination worn) {
    worn_.push_back(std::move(worn));
    return static_cast<std::uint32_t>(worn_.size() - 1);
  }

  /// Characters so far index worn_, which holds equal ones and ones that nobody wears.
  void internCombinations() {
    std::vector<std::uint8_t> is_worn(worn_.size(), 0);
    for (const Character& character : crowd_.characters) is_worn[character.combination] = 1;
    const auto before = [](const WornCombination& a, const WornCombination& b) {
      return a.wardrobe != b.wardrobe ? a.wardrobe < b.wardrobe : a.items < b.items;
    };
    std::vector<WornCombination>& distinct = crowd_.combinations;
    for (std::size_t i = 0; i < worn_.size(); ++i) {
      if (is_worn[i] != 0) distinct.push_back(worn_[i]);
    }
    std::sort(distinct.begin(), distinct.end(), before);
    distinct.erase(std::unique(distinct.begin(), distinct.end()), distinct.end());
    std::vector<std::uint32_t> renumbered(worn_.size(), 0);
    for (std::size_t i = 0; i < worn_.size(); ++i) {
      if (is_worn[i] == 0) continue;
      const auto found = std::lower_bound(distinct.begin(), distinct.end(), worn_[i], before);
      renumbered[i] = static_cast<std::uint32_t>(found - distinct.begin());
    }
    for (Character& character : crowd_.characters) character.combination = renumbered[character.combination];
  }

  const Scene& scene_;
  std::span<const Wardrobe> wardrobes_;
  SceneNames names_;
  std::optional<CrowdOfTable> table_;  ///< where the crowd comes from one
  WeightedChoice wardrobe_;
  std::vector<WardrobeChoices> choices_;
  std::vector<WornCombination> worn_;
  Crowd crowd_;
};

}  // namespace

Mat4 Character::worldFromModel() const {
  const float sine = std::sin(heading) * scale, cosine = std::cos(heading) * scale;
  return Mat4(Vec4(cosine, 0.0f, -sine, 0.0f), Vec4(0.0f, scale, 0.0f, 0.0f), Vec4(sine, 0.0f, cosine, 0.0f),
              Vec4(position, 1.0f));
}

CharacterPose poseAt(const Crowd& crowd, const Character& character, float clip_seconds, double seconds) {
  CharacterPose pose;
  Character now = character;
  pose.clip = pose.idle_clip = character.clip;
  if (!character.walker) {
    pose.phase = phaseAt(seconds, clip_seconds, character.phase, character.speed);
  } else {
    const Walker& walker = crowd.walkers[*character.walker];
    const WalkStyle& style = crowd.walk_styles[walker.style];
    const WalkerPose walked = walkAt(walker, crowd.journeys[walker.journey], style, character.scale, seconds);
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
