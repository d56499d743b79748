#include "assetpipe/find_layers.h"

#include <algorithm>
#include <vector>

#include "assetpipe/layer_file.h"
#include "core/input_error.h"
#include "core/log.h"
#include "core/progress.h"

namespace ensemble {
namespace {

/// Keeps what was found, until that fails once.
class LayerKeeper {
 public:
  LayerKeeper(const Wardrobe& wardrobe, const HiddenFaceOptions& options)
      : wardrobe_(wardrobe),
        options_(options),
        has_files_(wardrobe.item_sha256.size() == wardrobe.items.size()) {}

  std::optional<HiddenGarmentFaces> find(ItemPair pair) const {
    return has_files_ ? readLayer(wardrobe_, pair, options_) : std::nullopt;
  }

  void keep(ItemPair pair, const HiddenGarmentFaces& hidden) {
    if (!has_files_ || has_failed_) return;
    try {
      writeLayer(wardrobe_, pair, hidden, options_);
    } catch (const SystemError& error) {
      has_failed_ = true;
      logWarning(wardrobe_.folder.string() +
                 ": what items hide of one another can't be kept here and is found anew each time (" +
                 error.what() + ")");
    }
  }

 private:
  const Wardrobe& wardrobe_;
  const HiddenFaceOptions& options_;
  bool has_files_, has_failed_ = false;
};

}  // namespace

HiddenGarmentFaces findHiddenUnder(const Item& inner, const Item& outer, const TemplateBody& body,
                                   const FaceHoles& alone, const HiddenFaceOptions& options) {
  const FaceHoles under = findHolesUnder(inner, outer, body, alone, options);
  HiddenGarmentFaces hidden(under.faces.size(), 0);
  std::size_t first = 0;
  for (const Garment& garment : inner.garments) {
    for (const ItemPart& part : garment.parts) {
      const std::size_t end = first + part.faces.size();
      bool is_covered = false;
      for (std::size_t f = first; f < end; ++f) {
        is_covered = is_covered || (alone.faces[FaceId(f)].is_kept && !under.faces[FaceId(f)].is_kept);
      }
      for (std::size_t f = first; f < end && is_covered; ++f)
        hidden[f] = under.faces[FaceId(f)].is_kept ? 0 : 1;
      first = end;
    }
  }
  return hidden;
}

void findLayers(Wardrobe& wardrobe, std::span<const ItemPair> pairs, const HiddenFaceOptions& options) {
  LayerKeeper keeper(wardrobe, options);
  std::vector<ItemPair> missing;
  for (const ItemPair& pair : pairs) {
    if (wardrobe.hidden_under.contains(pair)) continue;
    std::optional<HiddenGarmentFaces> kept = keeper.find(pair);
    if (kept) {
      wardrobe.hidden_under.emplace(pair, std::move(*kept));
    } else {
      missing.push_back(pair);
    }
  }
  std::sort(missing.begin(), missing.end());  // by the inner item, which is looked at alone once
  Progress progress("layers", missing.size());
  std::optional<FaceHoles> alone;
  for (std::size_t i = 0; i < missing.size(); ++i) {
    const Item& inner = wardrobe.items[missing[i].inner];
    if (i == 0 || missing[i].inner != missing[i - 1].inner) {
      alone = findHolesOf(inner, wardrobe.body, options);
    }
    HiddenGarmentFaces hidden =
        findHiddenUnder(inner, wardrobe.items[missing[i].outer], wardrobe.body, *alone, options);
    keeper.keep(missing[i], hidden);
    wardrobe.hidden_under.emplace(missing[i], std::move(hidden));
    progress.advance();
  }
}

}  // namespace ensemble
