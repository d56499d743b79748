// Which stream of random numbers decides what about a person (random.h). A number keeps its
// meaning for ever: another order would change every crowd.
#pragma once

#include <cstdint>

namespace ensemble::crowd_stream {

inline constexpr std::uint64_t kWardrobe = 1;
inline constexpr std::uint64_t kOutfit = 2;
inline constexpr std::uint64_t kClip = 3;
inline constexpr std::uint64_t kPhase = 4;
inline constexpr std::uint64_t kHeading = 5;
inline constexpr std::uint64_t kScale = 6;
inline constexpr std::uint64_t kTint = 7;
inline constexpr std::uint64_t kJitterX = 8;
inline constexpr std::uint64_t kJitterZ = 9;
inline constexpr std::uint64_t kDisc = 10;
inline constexpr std::uint64_t kPersonTint = 11;  ///< of `people`, by number in the file
inline constexpr std::uint64_t kPathShift = 12;   ///< by number in the crowd, lanes from 2^40 on
inline constexpr std::uint64_t kLaneSpeed = 13;   ///< by number of the lane
inline constexpr std::uint64_t kFirstFoot = 14;
inline constexpr std::uint64_t kWear = 15;  ///< and the number of the slot: 15 to 21

}  // namespace ensemble::crowd_stream
