// Indices that say of what, and arrays that only take the right one.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

namespace ensemble {

/// A typed index. Default constructed it is `none()`.
template <class Tag>
struct Id {
  static constexpr std::uint32_t kNone = 0xffffffffu;
  std::uint32_t value = kNone;

  constexpr Id() = default;
  constexpr explicit Id(std::size_t index) : value(static_cast<std::uint32_t>(index)) {}
  static constexpr Id none() { return Id(); }
  constexpr bool valid() const { return value != kNone; }
  constexpr auto operator<=>(const Id&) const = default;  // NOLINT(modernize-use-nullptr): it sees a 0
};

using FaceId = Id<struct FaceTag>;            ///< a triangle of the template, in source order
using VertexId = Id<struct VertexTag>;        ///< a wedge of the template, in source order
using PositionId = Id<struct PositionTag>;    ///< a distinct position; several wedges may share it
using RegionId = Id<struct RegionTag>;        ///< a region of the template
using JointId = Id<struct JointTag>;          ///< a joint of the skeleton
using ItemId = Id<struct ItemTag>;            ///< an item (one outfit file) of a wardrobe
using MeshId = Id<struct MeshTag>;            ///< a distinct mesh of SubMeshLists
using IndexListId = Id<struct IndexListTag>;  ///< a distinct index list of SubMeshLists
using SubMeshId = Id<struct SubMeshTag>;      ///< what is drawn with one queue
using CharacterId = Id<struct CharacterTag>;  ///< a person of the crowd

/// An array indexed by one kind of id.
template <class IdType, class T>
class PerId {
 public:
  PerId() = default;
  explicit PerId(std::size_t count, const T& value = T()) : data_(count, value) {}
  explicit PerId(std::vector<T> data) : data_(std::move(data)) {}

  decltype(auto) operator[](IdType id) { return data_[id.value]; }
  decltype(auto) operator[](IdType id) const { return data_[id.value]; }
  std::size_t size() const { return data_.size(); }
  bool empty() const { return data_.empty(); }
  IdType push(T value) {
    data_.push_back(std::move(value));
    return IdType(data_.size() - 1);
  }
  void assign(std::size_t count, const T& value) { data_.assign(count, value); }
  auto begin() { return data_.begin(); }
  auto end() { return data_.end(); }
  auto begin() const { return data_.begin(); }
  auto end() const { return data_.end(); }
  const std::vector<T>& raw() const { return data_; }
  std::vector<T>& raw() { return data_; }
  bool operator==(const PerId&) const = default;

 private:
  std::vector<T> data_;
};

template <class T>
using PerFace = PerId<FaceId, T>;
template <class T>
using PerVertex = PerId<VertexId, T>;
template <class T>
using PerRegion = PerId<RegionId, T>;
template <class T>
using PerItem = PerId<ItemId, T>;

}  // namespace ensemble

template <class Tag>
struct std::hash<ensemble::Id<Tag>> {
  std::size_t operator()(const ensemble::Id<Tag>& id) const { return std::hash<std::uint32_t>{}(id.value); }
};
