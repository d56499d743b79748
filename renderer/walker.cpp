#include "renderer/walker.h"

#include <algorithm>
#include <cmath>

#include "renderer/animation.h"

namespace ensemble {
namespace {

// Parts of the walk clip next to a stand in which the foot that came last does not move any more.
constexpr double kSettled = 0.02;

double smoothStep(double from, double to, double x) {
  const double u = std::clamp((x - from) / std::max(to - from, 1e-9), 0.0, 1.0);
  return u * u * (3.0 - 2.0 * u);
}

float fraction(double x) {
  const auto part = static_cast<float>(x - std::floor(x));
  return part < 1.0f ? part : 0.0f;
}

/// A foot on the ground, or on its way.
struct FootPlace {
  Vec2 ground{0.0f};  ///< x, z in the world
  float heading = 0.0f;
};

FootPlace mix(const FootPlace& a, const FootPlace& b, double part) {
  const auto p = static_cast<float>(part);
  return {glm::mix(a.ground, b.ground, p), glm::mix(a.heading, b.heading, p)};
}

Vec3 ankleAt(const std::vector<std::array<Vec3, 2>>& keys, std::size_t foot, double phase) {
  if (keys.size() == 1) return keys[0][foot];
  const double at = fraction(phase) * static_cast<double>(keys.size() - 1);
  const std::size_t key = std::min(static_cast<std::size_t>(at), keys.size() - 2);
  return glm::mix(keys[key][foot], keys[key + 1][foot], static_cast<float>(at - static_cast<double>(key)));
}

/// The phase of the walk over one stretch of somebody's journey: linear in the distance. Unwrapped.
struct StretchPhase {
  double begin = 0.0, end = 0.0;  ///< distances
  double phase_at_begin = 0.0, per_metre = 1.0;
  std::size_t foot_at_begin = 0, foot_at_end = 0;  ///< that it stands on, where it stands

  double phaseAt(double distance) const { return phase_at_begin + (distance - begin) * per_metre; }
  double distanceAt(double phase) const { return begin + (phase - phase_at_begin) / per_metre; }
};

class WalkerEvaluation {
 public:
  WalkerEvaluation(const Walker& walker, const Journey& journey, const WalkStyle& style, float scale)
      : walker_(walker),
        journey_(journey),
        style_(style),
        scale_(scale),
        stride_(double{style.stride} * scale) {}

  WalkerPose at(double seconds, FeetOf feet) {
    const Journey::Moment moment = journey_.at(walker_.head_start + seconds);
    findStretch(moment);
    const double phase = stretch_.phaseAt(moment.distance);
    const Route::At place = journey_.placeAt(moment.distance);
    WalkerPose pose;
    pose.exists = moment.exists;
    pose.position = place.position;
    pose.heading = place.heading;
    pose.speed = static_cast<float>(moment.speed);
    pose.walk_phase = fraction(phase);
    pose.idle_phase = phaseAt(seconds, style_.idle_seconds, walker_.phase, 1.0f);
    if (style_.idle_clip) {
      pose.idle_weight =
          1.0f - static_cast<float>(smoothStep(0.0, double{style_.idle_below} * scale_, moment.speed));
    }
    pose.holds_feet = style_.gait.has_value();
    if (pose.holds_feet && feet == FeetOf::kAll) holdFeet(phase, pose);
    return pose;
  }

 private:
  double middleOf(std::size_t foot) const {
    return style_.gait ? style_.gait->contacts[foot].middle : 0.5 * static_cast<double>(foot);
  }

  /// Half steps between two stands: a whole number, so that each is reached in mid-step.
  std::int64_t halfSteps(const Journey::Stretch& stretch) const {
    const double length = journey_.endOf(stretch) - journey_.beginOf(stretch);
    if (length <= 0.0) return 0;
    return std::max<std::int64_t>(1, std::llround(length / (0.5 * stride_)));
  }

  void findStretch(const Journey::Moment& moment) {
    std::int64_t steps = 0;  // half steps from the first stand to this stretch
    const std::vector<Journey::Stretch>& stretches = journey_.stretches();
    if (journey_.repeat() == Journey::Repeat::kRoundTheLoop) {
      for (const Journey::Stretch& stretch : stretches) {
        if (stretch.begins_standing) steps += halfSteps(stretch) * (moment.lap & 1);
      }
    }
    for (std::size_t i = 0; i < moment.stretch; ++i) {
      if (stretches[i].begins_standing) steps += halfSteps(stretches[i]);
    }
    const Journey::Stretch& stretch = stretches[moment.stretch];
    stretch_.begin = journey_.beginOf(stretch);
    stretch_.end = journey_.endOf(stretch);
    stands_at_begin_ = stretch.begins_standing;
    stands_at_end_ = stretch.ends_standing;
    stretch_.foot_at_begin = (walker_.first_foot + static_cast<std::size_t>(steps & 1)) & 1u;
    stretch_.foot_at_end = stretch_.foot_at_begin;
    stretch_.per_metre = 1.0 / stride_;
    if (!stands_at_begin_ && !stands_at_end_) {
      const double before = journey_.repeat() == Journey::Repeat::kRoundTheLoop
                                ? static_cast<double>(moment.lap) * (stretch_.end - stretch_.begin)
                                : 0.0;
      stretch_.phase_at_begin = walker_.phase + before / stride_;
      // Whole turns mean nothing, and large numbers lose their digits.
      stretch_.phase_at_begin -= std::floor(stretch_.phase_at_begin);
    } else if (!stands_at_begin_) {
      stretch_.phase_at_begin = middleOf(stretch_.foot_at_end) - (stretch_.end - stretch_.begin) / stride_;
    } else {
      stretch_.phase_at_begin = middleOf(stretch_.foot_at_begin);
      if (stands_at_end_) stretchStride(halfSteps(stretch));
    }
  }

  void stretchStride(std::int64_t half_steps) {
    stretch_.foot_at_end = (stretch_.foot_at_begin + static_cast<std::size_t>(half_steps & 1)) & 1u;
    if (half_steps == 0) return;
    const std::int64_t whole_turns = half_steps / 2;
    auto turns = static_cast<double>(whole_turns);
    if ((half_steps & 1) != 0) {
      const double next = middleOf(stretch_.foot_at_end) - middleOf(stretch_.foot_at_begin);
      turns += next - std::floor(next);
    }
    stretch_.per_metre = turns / (stretch_.end - stretch_.begin);
  }

  /// Where something of the figure is while the figure is at a distance of its journey.
  FootPlace placeOf(Vec3 model, double distance) const {
    const Route::At at = journey_.placeAt(distance);
    const float sine = std::sin(at.heading), cosine = std::cos(at.heading);
    return {Vec2(at.position.x, at.position.z) +
                scale_ * Vec2(cosine * model.x + sine * model.z, cosine * model.z - sine * model.x),
            at.heading};
  }

  /// Where a foot is in the walk as it comes, without being held.
  FootPlace walkingPlace(std::size_t foot, double phase) const {
    return placeOf(ankleAt(style_.walk_ankles, foot, phase), stretch_.distanceAt(phase));
  }

  /// The place of a foot that stands, from the print of the contact whose middle is at phase `middle`.
  FootPlace printedPlace(std::size_t foot, double phase, double middle) const {
    Vec3 ankle = ankleAt(style_.walk_ankles, foot, phase);
    ankle.z += style_.stride * static_cast<float>(phase - middle);
    return placeOf(ankle, stretch_.distanceAt(middle));
  }

  /// Both feet of a walk that goes on for ever: on prints, or on the way from one to the next.
  FootPlace heldPlace(std::size_t foot, double phase) const {
    const Contact& contact = style_.gait->contacts[foot];
    const double turn = std::floor(phase - contact.begin);
    const double middle = contact.middle + turn, end = contact.end + turn, next = contact.begin + turn + 1.0;
    if (phase <= end) return printedPlace(foot, phase, middle);
    // What the prints before and after take it off the walk, faded from one to the other.
    const FootPlace now = walkingPlace(foot, phase);
    const double part = smoothStep(end, next, phase);
    const FootPlace shifted =
        mix(shiftFromWalk(foot, end, middle), shiftFromWalk(foot, next, middle + 1.0), part);
    const Vec2 shift = inWorld(shifted.ground, now.heading);
    return {now.ground + shift, now.heading + shifted.heading};
  }

  /// What a print takes a foot off the walk, in the figure's frame.
  FootPlace shiftFromWalk(std::size_t foot, double phase, double middle) const {
    const FootPlace held = printedPlace(foot, phase, middle), walking = walkingPlace(foot, phase);
    return {inModel(held.ground - walking.ground, walking.heading), held.heading - walking.heading};
  }

  static Vec2 inWorld(Vec2 model, float heading) {
    const float sine = std::sin(heading), cosine = std::cos(heading);
    return {cosine * model.x + sine * model.y, cosine * model.y - sine * model.x};
  }
  static Vec2 inModel(Vec2 world, float heading) { return inWorld(world, -heading); }

  /// The foot that comes to stand beside the other at a stand, or leaves from there.
  FootPlace standingPlace(std::size_t foot, double distance) const {
    return placeOf(ankleAt(style_.idle_ankles, foot, 0.0), distance);
  }

  FootPlace footPlace(std::size_t foot, double phase) const {
    const Contact& contact = style_.gait->contacts[foot];
    FootPlace place = heldPlace(foot, phase);
    if (style_.idle_ankles.empty()) return place;
    if (stands_at_begin_ && foot != stretch_.foot_at_begin) {
      const double from = stretch_.phase_at_begin + kSettled;
      const double to = contact.begin + std::ceil(stretch_.phase_at_begin - contact.begin);
      if (phase < to)
        place = mix(standingPlace(foot, stretch_.begin), place, smoothStep(from, std::max(to, from), phase));
    }
    if (stands_at_end_ && foot != stretch_.foot_at_end) {
      const double phase_at_end = stretch_.phaseAt(stretch_.end);
      const double to = phase_at_end - kSettled;
      const double from = contact.end + std::floor(phase_at_end - contact.end);
      if (phase > from)
        place = mix(place, standingPlace(foot, stretch_.end), smoothStep(std::min(from, to), to, phase));
    }
    return place;
  }

  void holdFeet(double phase, WalkerPose& pose) const {
    const Vec2 ground(pose.position.x, pose.position.z);
    for (std::size_t foot = 0; foot < 2; ++foot) {
      Vec3 natural = ankleAt(style_.walk_ankles, foot, phase);
      if (!style_.idle_ankles.empty()) {
        natural = glm::mix(natural, ankleAt(style_.idle_ankles, foot, pose.idle_phase), pose.idle_weight);
      }
      const FootPlace held = footPlace(foot, phase);
      const Vec2 target = inModel(held.ground - ground, pose.heading) / scale_;
      pose.feet[foot] = {target.x - natural.x, target.y - natural.z, held.heading - pose.heading};
    }
  }

  const Walker& walker_;
  const Journey& journey_;
  const WalkStyle& style_;
  float scale_;
  double stride_;
  StretchPhase stretch_;
  bool stands_at_begin_ = false, stands_at_end_ = false;
};

}  // namespace

WalkerPose walkAt(const Walker& walker, const Journey& journey, const WalkStyle& style, float scale,
                  double seconds, FeetOf feet) {
  return WalkerEvaluation(walker, journey, style, scale).at(seconds, feet);
}

}  // namespace ensemble
