#include "renderer/tints.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <span>
#include <string>

namespace ensemble {
namespace {

/// sRGB as 0xRRGGBB.
using Hex = std::uint32_t;

// From pale to dark; a person has one for all of the body.
constexpr std::array<Hex, 12> kSkin = {0xf0cdb4, 0xe8bd9f, 0xe3b492, 0xdba883, 0xcf9a73, 0xc28b62,
                                       0xb17b55, 0x9c6847, 0x86563a, 0x70462f, 0x5b3826, 0x472b1e};
constexpr std::array<Hex, 12> kHair = {0x1c1613, 0x241b16, 0x2c2019, 0x38271c, 0x45301f, 0x543a25,
                                       0x6b4a2d, 0x8a6238, 0xa98052, 0x6e3b22, 0x8d8681, 0x4a4644};
constexpr std::array<Hex, 10> kShoes = {0x1b1a1c, 0x242325, 0x2f2723, 0x4a3224, 0x6a4a33,
                                        0x8b6a4c, 0xd9d6cf, 0xb9b4ab, 0x39424f, 0x5a5c60};
// Denims, neutrals, khakis and browns first, then whites, muted colours, and a few strong ones.
constexpr std::array<Hex, 46> kCloth = {
    0x2b3a55, 0x34496b, 0x4a6287, 0x243049, 0x3d4f6e, 0x5c6f8e, 0x26272c, 0x35363b, 0x4b4c50, 0x6d6a68,
    0x1f2126, 0x8f8578, 0xb5aa97, 0xa58a66, 0x8a6e4f, 0x5a4335, 0x6f5240, 0x59623f, 0x4a5443, 0x6b6f4a,
    0xcfc8ba, 0x3a3f47, 0x2e3b52, 0x7b7466, 0xe4e0d6, 0xf0eee8, 0xd8d9dc, 0x9ba0a6, 0xb9c8d3, 0x8fa6c0,
    0x7f95a0, 0x6580a3, 0x9aa27f, 0xc1a883, 0x7c3238, 0x96484a, 0xb5605a, 0xc98a7a, 0x6d4a63, 0xc69a3f,
    0xa9702f, 0x2f6a63, 0x3a5560, 0xc0553b, 0xe9e4d4, 0x2c4f86};
// Of these, what trousers are made of.
constexpr std::uint32_t kLowerCloth = 24;

struct KindColors {
  TintKind kind;
  std::span<const Hex> colors;
  TintRange range;  ///< first and count are filled in
};

const std::array<KindColors, 4>& kinds() {
  static const std::array<KindColors, 4> all = [] {
    std::array<KindColors, 4> table = {{
        {TintKind::kSkin,
         kSkin,
         {.strength = 1.0f, .textured_strength = 1.0f, .spread = 0.04f, .sheen = 0.05f}},
        {TintKind::kHair,
         kHair,
         {.strength = 1.0f, .textured_strength = 0.8f, .spread = 0.12f, .sheen = 0.06f}},
        {TintKind::kShoes,
         kShoes,
         {.strength = 1.0f, .textured_strength = 0.5f, .spread = 0.10f, .sheen = 0.03f}},
        {TintKind::kCloth,
         kCloth,
         {.lower_count = kLowerCloth,
          .strength = 1.0f,
          .textured_strength = 0.6f,
          .spread = 0.14f,
          .sheen = 0.05f}},
    }};
    std::uint32_t first = 0;
    for (KindColors& entry : table) {
      entry.range.first = first;
      entry.range.count = static_cast<std::uint32_t>(entry.colors.size());
      first += entry.range.count;
    }
    return table;
  }();
  return all;
}

float linearByte(std::uint32_t byte) {
  const float c = static_cast<float>(byte) / 255.0f;
  return c <= 0.04045f ? c / 12.92f : std::pow((c + 0.055f) / 1.055f, 2.4f);
}

std::string lowerCase(std::string_view text) {
  std::string lower(text);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return lower;
}

bool containsAny(const std::string& text, std::initializer_list<const char*> words) {
  return std::any_of(words.begin(), words.end(),
                     [&](const char* word) { return text.find(word) != std::string::npos; });
}

}  // namespace

TintKind tintKindOf(std::string_view material_name, bool is_body) {
  const std::string name = lowerCase(material_name);
  if (name.starts_with("fixed.")) return TintKind::kNone;
  if (containsAny(name, {"brow"})) return TintKind::kHair;
  if (containsAny(name, {"eye", "teeth", "tooth", "tongue", "lash", "nail"})) return TintKind::kNone;
  if (name.starts_with("hair")) return TintKind::kHair;
  if (is_body) return TintKind::kSkin;
  if (containsAny(name, {"shoe", "boot", "sandal", "sneaker"})) return TintKind::kShoes;
  return TintKind::kCloth;
}

TintRange tintRange(TintKind kind) {
  for (const KindColors& entry : kinds()) {
    if (entry.kind == kind) return entry.range;
  }
  return {};
}

const std::vector<Vec4>& tintTable() {
  static const std::vector<Vec4> table = [] {
    std::vector<Vec4> colors;
    for (const KindColors& entry : kinds()) {
      for (const Hex hex : entry.colors) {
        colors.emplace_back(linearByte(hex >> 16), linearByte(hex >> 8 & 0xffu), linearByte(hex & 0xffu),
                            1.0f);
      }
    }
    return colors;
  }();
  return table;
}

std::uint32_t tintKey(TintKind kind, std::string_view garment_name) {
  if (kind == TintKind::kSkin || kind == TintKind::kHair) garment_name = {};
  std::uint32_t hash = 2166136261u + static_cast<std::uint32_t>(kind);  // FNV-1a
  for (const char c : garment_name) hash = (hash ^ static_cast<unsigned char>(c)) * 16777619u;
  return hash;
}

}  // namespace ensemble
