// Who walks where: a crowd on a scene's paths, or along the trajectories of a file.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/scene.h"
#include "core/trajectory_file.h"
#include "core/wardrobe.h"
#include "renderer/journey.h"
#include "renderer/walker.h"

namespace ensemble {

struct CrowdWalkers {
  std::vector<Journey> journeys;
  std::vector<Walker> walkers;  ///< one a person; `style` is still to be told
};

/// A path that can't be walked as the scene asks.
struct PathProblem {
  SourceMark mark;
  std::string what, mend;
};

/// Spreads `count` people over paths by weight and number of lanes, and along each lane evenly with a
/// random shift, so that no two come nearer than `placement.spacing`, stops included: all of a lane
/// walk at one speed, one after the other.
/// @param usual_speed metres a second, where the scene tells none: lanes differ by 5 % to both sides
/// @throws PathProblem for a corner too tight for the path's width, a stop beyond the end, or more
/// people than there is room for, which it tells
CrowdWalkers placeOnPaths(const ScenePlacement& placement, std::uint32_t count, std::uint64_t seed,
                          float usual_speed);

/// Everybody along their own trajectory, averaged over `walking.smoothing` seconds (a walker's head
/// sways), standing where they hardly move.
/// @param fps frames a second of the trajectories
CrowdWalkers followTrajectories(const Trajectories& trajectories, float fps, const ScenePlacement& placement);

/// How a template's people walk with a clip. @pre the walk clip has ground speed
WalkStyle makeWalkStyle(const TemplateBody& body, std::uint32_t walk_clip,
                        std::optional<std::uint32_t> idle_clip, float idle_below);

}  // namespace ensemble
