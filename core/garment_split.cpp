#include "core/garment_split.h"

#include <algorithm>
#include <limits>
#include <map>
#include <string>

#include "core/check.h"
#include "core/layers.h"

namespace ensemble {
namespace {

/// Faces of a part that are hidden alike.
struct Piece {
  std::vector<std::uint8_t> hidden;  ///< per set
  std::vector<std::size_t> faces;
};

/// Faces that would be drawn needlessly, over all sets, if two pieces were one.
std::size_t costOf(const Piece& a, const Piece& b) {
  std::size_t cost = 0;
  for (std::size_t s = 0; s < a.hidden.size(); ++s) {
    if (a.hidden[s] != b.hidden[s]) cost += a.hidden[s] != 0 ? a.faces.size() : b.faces.size();
  }
  return cost;
}

void join(Piece& into, const Piece& other) {
  for (std::size_t s = 0; s < into.hidden.size(); ++s) into.hidden[s] &= other.hidden[s];
  into.faces.insert(into.faces.end(), other.faces.begin(), other.faces.end());
}

void joinSmallest(std::vector<Piece>& pieces) {
  const auto smaller = [](const Piece& a, const Piece& b) { return a.faces.size() < b.faces.size(); };
  const auto smallest = std::min_element(pieces.begin(), pieces.end(), smaller);
  auto best = pieces.end();
  std::size_t least = std::numeric_limits<std::size_t>::max();
  for (auto piece = pieces.begin(); piece != pieces.end(); ++piece) {
    if (piece == smallest || costOf(*piece, *smallest) >= least) continue;
    least = costOf(*piece, *smallest);
    best = piece;
  }
  join(*best, *smallest);
  pieces.erase(smallest);
}

/// Pieces of the faces first .. first + count, those that the fewest sets hide first.
std::vector<Piece> piecesOf(std::size_t first, std::size_t count, std::span<const HiddenGarmentFaces> sets,
                            std::size_t most) {
  std::map<std::string, std::vector<std::size_t>> by_hidden;
  for (std::size_t face = first; face < first + count; ++face) {
    std::string hidden;
    for (const HiddenGarmentFaces& set : sets) hidden += set.empty() || set[face] == 0 ? '0' : '1';
    by_hidden[std::move(hidden)].push_back(face);
  }
  std::vector<Piece> pieces;
  for (auto& [hidden, faces] : by_hidden) {
    Piece& piece = pieces.emplace_back();
    for (const char digit : hidden) piece.hidden.push_back(digit == '1' ? 1 : 0);
    piece.faces = std::move(faces);
  }
  while (pieces.size() > most) joinSmallest(pieces);
  return pieces;
}

}  // namespace

GarmentSplit splitGarments(const Item& item, std::span<const HiddenGarmentFaces> sets, std::size_t most) {
  ENSEMBLE_CHECK(most > 0);
  const std::size_t faces = item.garmentFaceCount();
  for (const HiddenGarmentFaces& set : sets) ENSEMBLE_CHECK(set.empty() || set.size() == faces);
  GarmentSplit split;
  split.piece_of_face.resize(faces);
  split.hidden.resize(sets.size());
  std::size_t first = 0;
  for (const Garment& garment : item.garments) {
    for (const ItemPart& part : garment.parts) {
      for (const Piece& piece : piecesOf(first, part.faces.size(), sets, most)) {
        for (const std::size_t face : piece.faces) split.piece_of_face[face] = split.piece_count;
        for (std::size_t s = 0; s < sets.size(); ++s) split.hidden[s].push_back(piece.hidden[s]);
        ++split.piece_count;
      }
      first += part.faces.size();
    }
  }
  return split;
}

std::map<ItemId, ItemSets> hiddenSets(const Wardrobe& wardrobe, std::span<const Combination> combinations,
                                      std::vector<std::map<ItemId, std::size_t>>* set_of) {
  std::map<ItemId, ItemSets> all;
  for (const Combination& combination : combinations) {
    std::map<ItemId, std::size_t> numbers;
    for (const ItemId item : combination) {
      HiddenGarmentFaces hidden = hiddenInCombination(wardrobe, combination, item);
      ItemSets& of_item = all[item];
      const auto found = std::find(of_item.sets.begin(), of_item.sets.end(), hidden);
      const auto number = static_cast<std::size_t>(found - of_item.sets.begin());
      numbers[item] = number;
      if (found == of_item.sets.end()) {
        of_item.sets.push_back(std::move(hidden));
        of_item.times.push_back(0);
      }
      ++of_item.times[number];
    }
    if (set_of != nullptr) set_of->push_back(std::move(numbers));
  }
  return all;
}

LayerFigures& LayerFigures::operator+=(const LayerFigures& other) {
  pairs += other.pairs;
  garment_faces += other.garment_faces;
  hidden_faces += other.hidden_faces;
  drawn_faces += other.drawn_faces;
  lists += other.lists;
  return *this;
}

LayerFigures countLayers(const Wardrobe& wardrobe, std::span<const Combination> combinations) {
  LayerFigures figures;
  for (const ItemPair& pair : layerPairs(wardrobe, combinations)) {
    const auto found = wardrobe.hidden_under.find(pair);
    if (found == wardrobe.hidden_under.end()) continue;
    figures.pairs += std::count(found->second.begin(), found->second.end(), 0) <
                     static_cast<std::ptrdiff_t>(found->second.size());
  }
  for (const auto& [item, of_item] : hiddenSets(wardrobe, combinations)) {
    const GarmentSplit split = splitGarments(wardrobe.items[item], of_item.sets);
    figures.lists += split.piece_count;
    for (std::size_t s = 0; s < of_item.sets.size(); ++s) {
      const HiddenGarmentFaces& set = of_item.sets[s];
      for (std::size_t face = 0; face < split.piece_of_face.size(); ++face) {
        figures.garment_faces += of_item.times[s];
        figures.hidden_faces += !set.empty() && set[face] != 0 ? of_item.times[s] : 0;
        figures.drawn_faces += split.hidden[s][split.piece_of_face[face]] == 0 ? of_item.times[s] : 0;
      }
    }
  }
  return figures;
}

}  // namespace ensemble
