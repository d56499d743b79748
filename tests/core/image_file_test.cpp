#include "core/image_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>

#include <cstdio>
#include <cstring>

#include <jpeglib.h>

#include "core/check.h"
#include "core/input_error.h"

namespace ensemble {
namespace {

RawImage asImage(std::vector<std::byte> bytes) {
  RawImage image;
  image.name = "cloth";
  image.bytes = std::move(bytes);
  return image;
}

std::string refusal(const RawImage& image) {
  try {
    decodeImage(image, "x.glb");
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

constexpr const char* kDamaged =
    "x.glb: cloth: the image is damaged or of an unknown kind; convert the image to PNG or JPEG";

Image8 gradient(bool opaque) {
  Image8 image{13, 7, {}};
  for (std::uint32_t i = 0; i < 13 * 7; ++i) {
    const auto value = static_cast<std::uint8_t>(i);
    const std::uint8_t alpha = opaque ? std::uint8_t{255} : static_cast<std::uint8_t>(255 - i);
    image.rgba.insert(image.rgba.end(), {value, static_cast<std::uint8_t>(2 * value), 3, alpha});
  }
  return image;
}

// A PNG of any kind; rows are as the file holds them.
std::vector<std::byte> writePng(int color_type, int bit_depth,
                                const std::vector<std::vector<std::uint8_t>>& rows, std::uint32_t width,
                                bool interlaced = false) {
  std::vector<std::byte> out;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_set_write_fn(
      png, &out,
      [](png_structp writer, png_bytep bytes, std::size_t size) {
        auto* target = static_cast<std::vector<std::byte>*>(png_get_io_ptr(writer));
        const auto* first = reinterpret_cast<std::byte*>(bytes);
        target->insert(target->end(), first, first + size);
      },
      [](png_structp) {});
  png_set_IHDR(png, info, width, static_cast<std::uint32_t>(rows.size()), bit_depth, color_type,
               interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  png_color palette[2] = {{1, 2, 3}, {200, 100, 50}};
  png_byte transparency[1] = {77};
  if (color_type == PNG_COLOR_TYPE_PALETTE) {
    png_set_PLTE(png, info, palette, 2);
    png_set_tRNS(png, info, transparency, 1, nullptr);
  }
  png_write_info(png, info);
  std::vector<png_bytep> pointers;
  for (const auto& row : rows) pointers.push_back(const_cast<png_bytep>(row.data()));
  png_write_image(png, pointers.data());
  png_write_end(png, nullptr);
  png_destroy_write_struct(&png, &info);
  return out;
}

std::vector<std::byte> writeJpeg(const Image8& image, J_COLOR_SPACE space) {
  jpeg_compress_struct info;
  jpeg_error_mgr errors;
  info.err = jpeg_std_error(&errors);
  jpeg_create_compress(&info);
  unsigned char* data = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&info, &data, &size);
  info.image_width = image.width;
  info.image_height = image.height;
  info.input_components = space == JCS_GRAYSCALE ? 1 : 4;
  info.in_color_space = space;
  jpeg_set_defaults(&info);
  jpeg_set_quality(&info, 95, TRUE);
  jpeg_start_compress(&info, TRUE);
  while (info.next_scanline < info.image_height) {
    const std::size_t bytes_a_row =
        std::size_t{image.width} * static_cast<std::size_t>(info.input_components);
    auto* row = const_cast<JSAMPLE*>(image.rgba.data() + info.next_scanline * bytes_a_row);
    jpeg_write_scanlines(&info, &row, 1);
  }
  jpeg_finish_compress(&info);
  const auto* first = reinterpret_cast<std::byte*>(data);
  std::vector<std::byte> bytes(first, first + size);
  jpeg_destroy_compress(&info);
  free(data);
  return bytes;
}

TEST(ImageFile, PngRoundTrip) {
  for (const bool opaque : {true, false}) {
    const Image8 image = gradient(opaque);
    const std::vector<std::byte> bytes = encodePng(image);
    EXPECT_EQ(std::to_integer<int>(bytes[25]), opaque ? PNG_COLOR_TYPE_RGB : PNG_COLOR_TYPE_RGB_ALPHA);
    RawImage raw = asImage(bytes);
    readImageHeader(raw.bytes, "x.glb", "/images/0", raw);
    EXPECT_EQ(raw.width, 13u);
    EXPECT_EQ(raw.height, 7u);
    EXPECT_EQ(raw.mime_type, "image/png");
    const Image8 back = decodeImage(raw, "x.glb");
    EXPECT_EQ(back.width, 13u);
    EXPECT_EQ(back.rgba, image.rgba);
    EXPECT_EQ(encodePng(image), bytes);
  }
}

TEST(ImageFile, PngOfEveryKind) {
  const auto grey = decodeImage(asImage(writePng(PNG_COLOR_TYPE_GRAY, 8, {{0, 128}, {255, 7}}, 2)), "x");
  EXPECT_EQ(grey.rgba,
            (std::vector<std::uint8_t>{0, 0, 0, 255, 128, 128, 128, 255, 255, 255, 255, 255, 7, 7, 7, 255}));
  const auto bits = decodeImage(asImage(writePng(PNG_COLOR_TYPE_GRAY, 1, {{0x40}}, 2)), "x");
  EXPECT_EQ(bits.rgba, (std::vector<std::uint8_t>{0, 0, 0, 255, 255, 255, 255, 255}));
  const auto palette = decodeImage(asImage(writePng(PNG_COLOR_TYPE_PALETTE, 8, {{1, 0}}, 2)), "x");
  EXPECT_EQ(palette.rgba, (std::vector<std::uint8_t>{200, 100, 50, 255, 1, 2, 3, 77}));
  const auto deep =
      decodeImage(asImage(writePng(PNG_COLOR_TYPE_RGB, 16, {{0xff, 0xff, 0x80, 0x80, 0, 0}}, 1)), "x");
  EXPECT_EQ(deep.rgba, (std::vector<std::uint8_t>{255, 128, 0, 255}));
  const auto laced = decodeImage(
      asImage(writePng(PNG_COLOR_TYPE_GRAY_ALPHA, 8, {{1, 2, 3, 4}, {5, 6, 7, 8}}, 2, true)), "x");
  EXPECT_EQ(laced.rgba, (std::vector<std::uint8_t>{1, 1, 1, 2, 3, 3, 3, 4, 5, 5, 5, 6, 7, 7, 7, 8}));
}

TEST(ImageFile, Jpeg) {
  Image8 image{16, 8, {}};
  for (int i = 0; i < 16 * 8; ++i) image.rgba.insert(image.rgba.end(), {200, 100, 50, 0});
  RawImage raw = asImage(writeJpeg(image, JCS_EXT_RGBX));
  readImageHeader(raw.bytes, "x.glb", "", raw);
  EXPECT_EQ(raw.mime_type, "image/jpeg");
  EXPECT_EQ(raw.width, 16u);
  EXPECT_EQ(raw.height, 8u);
  const Image8 back = decodeImage(raw, "x.glb");
  for (std::size_t i = 0; i < back.rgba.size(); i += 4) {
    EXPECT_NEAR(back.rgba[i], 200, 2);
    EXPECT_NEAR(back.rgba[i + 1], 100, 2);
    EXPECT_NEAR(back.rgba[i + 2], 50, 2);
    EXPECT_EQ(back.rgba[i + 3], 255);
  }
  Image8 grey{8, 8, std::vector<std::uint8_t>(64, 90)};
  const Image8 back_grey = decodeImage(asImage(writeJpeg(grey, JCS_GRAYSCALE)), "x.glb");
  EXPECT_NEAR(back_grey.rgba[1], 90, 1);
}

TEST(ImageFile, RefusesOtherKinds) {
  RawImage image;
  const std::vector<std::byte> gif(64, std::byte{'G'});
  try {
    readImageHeader(gif, "x.glb", "/images/3", image);
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "x.glb: /images/3: the image is neither PNG nor JPEG; convert the image to PNG or JPEG");
  }
  EXPECT_EQ(refusal(asImage({})),
            "x.glb: cloth: the image is neither PNG nor JPEG; convert the image to PNG or JPEG");
}

TEST(ImageFile, RefusesDamage) {
  const std::vector<std::byte> png = encodePng(gradient(true));
  const std::vector<std::byte> jpeg = writeJpeg(gradient(true), JCS_EXT_RGBX);
  EXPECT_EQ(refusal(asImage({png.begin(), png.begin() + 20})),
            "x.glb: cloth: the image's header is damaged; convert the image to PNG or JPEG");
  EXPECT_EQ(refusal(asImage({jpeg.begin(), jpeg.begin() + 20})),
            "x.glb: cloth: the image's header is damaged; convert the image to PNG or JPEG");
  EXPECT_EQ(refusal(asImage({png.begin(), png.end() - 30})), kDamaged);
  EXPECT_EQ(refusal(asImage({jpeg.begin(), jpeg.end() - 40})), kDamaged);
  std::vector<std::byte> huge = png;
  huge[16] = std::byte{0x7f};
  EXPECT_EQ(refusal(asImage(huge)),
            "x.glb: cloth: the image's header is damaged; convert the image to PNG or JPEG");
  std::vector<std::byte> cmyk = writeJpeg(gradient(true), JCS_CMYK);
  EXPECT_EQ(refusal(asImage(cmyk)), kDamaged);
}

TEST(ImageFile, SurvivesRandomDamage) {
  std::uint64_t state = 3;
  const auto random = [&state](std::uint64_t below) {
    state = state * 6364136223846793005ull + 1442695040888963407ull;
    return (state >> 33) % below;
  };
  const std::vector<std::vector<std::byte>> sound = {encodePng(gradient(false)),
                                                     writeJpeg(gradient(true), JCS_EXT_RGBX)};
  int refused = 0;
  for (int round = 0; round < 4000; ++round) {
    std::vector<std::byte> bytes = sound[static_cast<std::size_t>(round % 2)];
    // Not the size: a picture of 65535 x 65535 is allowed here and only slow.
    for (int i = 0; i < 2; ++i) bytes[24 + random(bytes.size() - 24)] = static_cast<std::byte>(random(256));
    RawImage image = asImage(bytes);
    try {
      RawImage header;
      readImageHeader(image.bytes, "x", "", header);
      if (header.width * header.height > 1u << 20) continue;
    } catch (const InputError&) {
    }
    if (refusal(image) != "accepted") ++refused;
  }
  EXPECT_GT(refused, 500);
}

TEST(ImageFile, ChecksItsCaller) {
  EXPECT_THROW(encodePng({2, 2, {1, 2, 3}}), CheckError);
  EXPECT_THROW(encodePng({0, 0, {}}), CheckError);
}

}  // namespace
}  // namespace ensemble
