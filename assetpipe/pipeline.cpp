#include "assetpipe/pipeline.h"

#include <algorithm>
#include <mutex>
#include <set>

#include "assetpipe/ground_speed.h"
#include "assetpipe/mesh_levels.h"
#include "assetpipe/transfer_clips.h"
#include "assetpipe/wardrobe_builder.h"
#include "core/atomic_file.h"
#include "core/gltf_file.h"
#include "core/hash.h"
#include "core/input_error.h"
#include "core/log.h"
#include "core/nearest_name.h"
#include "core/parallel.h"
#include "core/progress.h"

namespace ensemble {
namespace fs = std::filesystem;
namespace {

/// The template that outfits are tagged for.
struct TaggingTemplate {
  TemplateBody body;
  std::string geometry_hash;
};

/// Prints what a file lost and what its author should know: one message for all that was dropped.
void tellAbout(const std::string& file, const std::vector<std::string>& dropped,
               const std::vector<std::string>& warnings) {
  if (!dropped.empty()) {
    std::string list;
    for (const std::string& what : dropped) list.append(list.empty() ? "" : ", ").append(what);
    logWarning(file + ": not used and dropped: " + list);
  }
  for (const std::string& warning : warnings) logWarning(file + ": " + warning);
}

GlbWriteOptions writeOptions(const PipelineOptions& options) {
  GlbWriteOptions write_options;
  write_options.draco = options.draco;
  return write_options;
}

/// The clips from `first` on, which came from `file`.
void putClipsInPlace(TemplateBody& body, std::size_t first, const std::string& file) {
  std::vector<std::string> warnings;
  for (std::size_t c = first; c < body.clips.size(); ++c) putInPlace(body.skeleton, body.clips[c], warnings);
  tellAbout(file, {}, warnings);
}

TaggingTemplate readTemplate(const fs::path& file, const PipelineOptions& options) {
  const RawAsset asset = readGltf(file);
  std::vector<std::string> warnings = asset.warnings;
  TaggingTemplate result;
  result.body = segmentTemplate(asset, options.segment, file.string(), warnings);
  tellAbout(file.string(), asset.dropped, warnings);
  putClipsInPlace(result.body, 0, file.string());
  for (const fs::path& clip_file : options.clips) {
    const RawAsset clips = readGltf(clip_file);
    tellAbout(clip_file.string(), {}, clips.warnings);
    const std::size_t first = result.body.clips.size();
    transferClips(clips, clip_file, result.body);
    putClipsInPlace(result.body, first, clip_file.string());
  }
  findLevels(result.body);
  result.geometry_hash = geometryHash(result.body);
  return result;
}

/// Outfits see the clips as the wardrobe's file rounds them, so that those added later see the same.
void takeWrittenClips(const std::vector<std::byte>& bytes, const std::string& file, TemplateBody& body) {
  GltfReadOptions as_numbered;
  as_numbered.weld = false;
  TemplateBody written = templateFromAsset(readGlb(bytes, file, as_numbered), file);
  body.skeleton = std::move(written.skeleton);
  body.clips = std::move(written.clips);
}

/// An outfit's name: its file's, without the ending.
std::string itemName(const fs::path& file) {
  std::string name = file.stem().string();
  if (isValidItemName(name)) return name;
  throw InputError({file.string(), "", "'" + name + "' can't be an outfit's name",
                    "rename the file: 1 to 100 characters, not beginning with a dot"});
}

/// What was asked for and does not happen to an outfit that is tagged already.
void tellAboutTagged(const std::string& file, const TagOptions& options) {
  if (options.garment_faces != 0) {
    logWarning(file +
               ": it is tagged already, so --garment-faces changes nothing; give the file that it was "
               "tagged from");
  }
  if (options.occlusion == Occlusion::kAuthored && options.explain.empty()) return;
  logWarning(file + ": it is tagged already, so its hidden faces stay as they are" +
             (options.explain.empty() ? "" : " and --explain has nothing to tell") +
             "; give the file that it was tagged from");
}

OutfitFile readOutfit(const fs::path& file, const TaggingTemplate& body, const PipelineOptions& options) {
  OutfitFile outfit;
  const RawAsset raw = readGltf(file);
  Item item;
  if (isTaggedItem(raw)) {
    // Ship as it is, byte for byte: read again with the file's own vertex numbers.
    outfit.bytes = readFile(file);
    tellAboutTagged(file.string(), options.tag);
    GltfReadOptions as_numbered;
    as_numbered.weld = false;
    item = itemFromAsset(readGlb(outfit.bytes, file.string(), as_numbered), body.body, body.geometry_hash,
                         file.string());
  } else {
    std::vector<std::string> warnings = raw.warnings;
    item = tagOutfit(raw, body.body, options.tag, itemName(file), file.string(), warnings);
    tellAbout(file.string(), raw.dropped, warnings);
    outfit.bytes = writeGlb(assetFromItem(item, body.body, body.geometry_hash), writeOptions(options));
  }
  const std::string sha256 = sha256Hex(outfit.bytes);
  outfit.entry = manifestEntry(item, body.body, outfitFileName(item.name, sha256), sha256);
  return outfit;
}

/// Reads and tags outfits on several threads; results and the first error are in the files' order.
std::vector<OutfitFile> readOutfits(const std::vector<fs::path>& files, const TaggingTemplate& body,
                                    const PipelineOptions& options) {
  std::vector<OutfitFile> outfits(files.size());
  const unsigned threads = threadCount(options.jobs);
  BareBody bare(body.body, options.tag.hidden);
  // What threads the outfits leave idle look for hidden faces.
  PipelineOptions options_of_one = options;
  options_of_one.tag.bare = &bare;
  options_of_one.tag.hidden.jobs =
      std::max(1u, threads / static_cast<unsigned>(std::clamp<std::size_t>(files.size(), 1, threads)));
  std::mutex progress_mutex;
  Progress progress("tagging", files.size());
  forEachOnThreads(threads, files.size(), [&](std::size_t i, unsigned) {
    outfits[i] = readOutfit(files[i], body, options_of_one);
    const std::lock_guard lock(progress_mutex);
    progress.advance();
  });
  return outfits;
}

void refuseSameNames(const std::vector<fs::path>& files, const std::vector<OutfitFile>& outfits) {
  std::set<std::string> names;
  for (std::size_t i = 0; i < outfits.size(); ++i) {
    if (names.insert(outfits[i].entry.name).second) continue;
    throw InputError({files[i].string(), "", "two outfits are named '" + outfits[i].entry.name + "'",
                      "rename one of the files"});
  }
}

ManifestTemplate templateEntry(const TaggingTemplate& body) {
  ManifestTemplate entry;
  entry.geometry_hash = body.geometry_hash;
  entry.faces = static_cast<std::uint32_t>(body.body.faces.size());
  entry.vertices = static_cast<std::uint32_t>(body.body.vertices.size());
  entry.joints = static_cast<std::uint32_t>(body.body.skeleton.joints.size());
  for (const Region& region : body.body.regions) entry.regions.push_back({region.name, region.face_count});
  for (const Clip& clip : body.body.clips) {
    entry.clips.push_back({clip.name, clip.seconds, clip.key_count, clip.ground_speed});
  }
  return entry;
}

}  // namespace

Manifest tagWardrobe(const fs::path& template_file, const std::vector<fs::path>& outfit_files,
                     const fs::path& folder, const PipelineOptions& options) {
  TaggingTemplate body = readTemplate(template_file, options);
  const std::vector<std::byte> template_bytes = writeGlb(assetFromTemplate(body.body), writeOptions(options));
  takeWrittenClips(template_bytes, template_file.string(), body.body);
  const std::vector<OutfitFile> outfits = readOutfits(outfit_files, body, options);
  refuseSameNames(outfit_files, outfits);

  WardrobeWriter writer(folder);
  Manifest manifest;
  manifest.body = templateEntry(body);
  manifest.body.sha256 = sha256Hex(template_bytes);
  manifest.body.file = writer.writeTemplate(template_bytes, manifest.body.sha256);
  for (const OutfitFile& outfit : outfits) {
    writer.writeOutfit(outfit);
    manifest.outfits.push_back(outfit.entry);
  }
  writer.commit(manifest);
  return manifest;
}

Manifest addOutfits(const fs::path& folder, const std::vector<fs::path>& outfit_files,
                    const PipelineOptions& options) {
  Wardrobe wardrobe = loadWardrobe(folder);
  const TaggingTemplate body{std::move(wardrobe.body), wardrobe.geometry_hash};
  const std::vector<OutfitFile> outfits = readOutfits(outfit_files, body, options);
  refuseSameNames(outfit_files, outfits);

  // Another writer may have come first: build on the manifest as it is under the lock.
  WardrobeWriter writer(folder);
  std::optional<Manifest> manifest = writer.currentManifest();
  if (!manifest || manifest->body.geometry_hash != body.geometry_hash) {
    throw InputError(
        {folder.string(), "", "the wardrobe was replaced while outfits were being tagged", "run it again"});
  }
  for (std::size_t i = 0; i < outfits.size(); ++i) {
    const auto same_name = [&](const ManifestOutfit& other) { return other.name == outfits[i].entry.name; };
    if (std::any_of(manifest->outfits.begin(), manifest->outfits.end(), same_name)) {
      throw InputError({outfit_files[i].string(), "",
                        "the wardrobe has an outfit '" + outfits[i].entry.name + "' already",
                        "remove that first (`ensemble remove`), or rename the file"});
    }
  }
  for (const OutfitFile& outfit : outfits) {
    writer.writeOutfit(outfit);
    manifest->outfits.push_back(outfit.entry);
  }
  writer.commit(*manifest);
  return *manifest;
}

Manifest removeOutfits(const fs::path& folder, const std::vector<std::string>& names) {
  if (!fs::exists(folder / "wardrobe.json")) {
    throw InputError({folder.string(), "", "there is no wardrobe here (no wardrobe.json)",
                      "give a folder made by `ensemble tag`"});
  }
  WardrobeWriter writer(folder);
  Manifest manifest = writer.currentManifest().value();
  for (const std::string& name : names) {
    const auto found = std::find_if(manifest.outfits.begin(), manifest.outfits.end(),
                                    [&](const ManifestOutfit& outfit) { return outfit.name == name; });
    if (found == manifest.outfits.end()) {
      std::vector<std::string> known;
      for (const ManifestOutfit& outfit : manifest.outfits) known.push_back(outfit.name);
      const std::vector<std::string> nearest = nearestNames(name, known);
      throw InputError(
          {folder.string(), "", "the wardrobe has no outfit " + quotedName(name),
           nearest.empty() ? "there is none to remove" : "did you mean " + quotedList(nearest) + "?"});
    }
    manifest.outfits.erase(found);
  }
  writer.commit(manifest);
  return manifest;
}

}  // namespace ensemble
