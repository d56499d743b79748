// libpng and libjpeg, both of which leave by longjmp: between setjmp and their calls stand only
// plain values, and what needs a destructor lives in the caller.
#include "core/image_file.h"

#include <fmt/format.h>
#include <png.h>

#include <csetjmp>
#include <cstdio>  // jpeglib.h needs FILE
#include <cstring>

#include <jerror.h>
#include <jpeglib.h>

#include "core/check.h"
#include "core/input_error.h"

namespace ensemble {
namespace {

constexpr std::uint8_t kPngSignature[8] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
constexpr const char* kConvert = "convert the image to PNG or JPEG";

std::uint8_t byteAt(std::span<const std::byte> bytes, std::size_t i) {
  return std::to_integer<std::uint8_t>(bytes[i]);
}

std::uint32_t bigEndian(std::span<const std::byte> bytes, std::size_t offset, std::size_t size) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < size; ++i) value = value << 8 | byteAt(bytes, offset + i);
  return value;
}

bool isPng(std::span<const std::byte> bytes) {
  return bytes.size() >= 8 && std::memcmp(bytes.data(), kPngSignature, 8) == 0;
}

bool isJpeg(std::span<const std::byte> bytes) {
  return bytes.size() >= 3 && bigEndian(bytes, 0, 3) == 0xffd8ff;
}

// Walks the segments to the start-of-frame marker. False if there is none.
bool findJpegSize(std::span<const std::byte> bytes, RawImage& image) {
  std::size_t offset = 2;
  while (offset + 4 <= bytes.size()) {
    if (byteAt(bytes, offset) != 0xff) return false;
    const std::uint8_t marker = byteAt(bytes, offset + 1);
    if (marker == 0xff) {  // a fill byte
      ++offset;
      continue;
    }
    const std::size_t length = bigEndian(bytes, offset + 2, 2);
    const bool is_frame =
        marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
    if (is_frame) {
      if (length < 8 || offset + 9 > bytes.size()) return false;
      image.height = bigEndian(bytes, offset + 5, 2);
      image.width = bigEndian(bytes, offset + 7, 2);
      return true;
    }
    if (length < 2) return false;
    offset += 2 + length;
  }
  return false;
}

/// A reader's or writer's place in memory.
struct PngInput {
  const std::byte* next = nullptr;
  std::size_t left = 0;
};

void readPngBytes(png_structp png, png_bytep out, std::size_t size) {
  auto* input = static_cast<PngInput*>(png_get_io_ptr(png));
  if (size > input->left) png_error(png, "the file ends too early");
  std::memcpy(out, input->next, size);
  input->next += size;
  input->left -= size;
}

void writePngBytes(png_structp png, png_bytep bytes, std::size_t size) {
  auto* output = static_cast<std::vector<std::byte>*>(png_get_io_ptr(png));
  const auto* first = reinterpret_cast<const std::byte*>(bytes);
  output->insert(output->end(), first, first + size);
}

void flushNothing(png_structp) {}
[[noreturn]] void failPng(png_structp png, png_const_charp) { png_longjmp(png, 1); }
void ignorePngWarning(png_structp, png_const_charp) {}

// Fills `rows` (each width * 4 bytes). Returns false for damaged data.
bool decodePngRows(PngInput& input, const Image8& size, std::span<png_bytep> rows) {
  png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, failPng, ignorePngWarning);
  png_infop info = png == nullptr ? nullptr : png_create_info_struct(png);
  if (info == nullptr) {
    png_destroy_read_struct(&png, nullptr, nullptr);
    return false;
  }
  if (setjmp(png_jmpbuf(png)) != 0) {
    png_destroy_read_struct(&png, &info, nullptr);
    return false;
  }
  png_set_read_fn(png, &input, readPngBytes);
  png_read_info(png, info);
  png_set_expand(png);  // palettes, 1 to 4 bits and tRNS become 8 bits
  png_set_scale_16(png);
  png_set_gray_to_rgb(png);
  png_set_add_alpha(png, 0xff, PNG_FILLER_AFTER);
  png_set_interlace_handling(png);
  png_read_update_info(png, info);
  const bool fits = png_get_image_width(png, info) == size.width &&
                    png_get_image_height(png, info) == size.height &&
                    png_get_rowbytes(png, info) == std::size_t{size.width} * 4;
  if (fits) {
    png_read_image(png, rows.data());
    png_read_end(png, nullptr);
  }
  png_destroy_read_struct(&png, &info, nullptr);
  return fits;
}

/// libjpeg's error handler, its jump, and whether data were missing.
struct JpegErrors {
  jpeg_error_mgr manager;
  std::jmp_buf jump;
  bool is_damaged = false;
};

[[noreturn]] void failJpeg(j_common_ptr info) {
  std::longjmp(reinterpret_cast<JpegErrors*>(info->err)->jump, 1);
}

// Libjpeg fills in what is missing with grey and only warns; a picture with grey bars is no picture.
void noteJpegMessage(j_common_ptr info, int level) {
  auto* errors = reinterpret_cast<JpegErrors*>(info->err);
  if (level < 0 && (info->err->msg_code == JWRN_JPEG_EOF || info->err->msg_code == JWRN_HIT_MARKER)) {
    errors->is_damaged = true;
  }
}

bool decodeJpegRows(std::span<const std::byte> bytes, Image8& image) {
  jpeg_decompress_struct info;
  JpegErrors errors;
  info.err = jpeg_std_error(&errors.manager);
  errors.manager.error_exit = failJpeg;
  errors.manager.emit_message = noteJpegMessage;
  if (setjmp(errors.jump) != 0) {
    jpeg_destroy_decompress(&info);
    return false;
  }
  jpeg_create_decompress(&info);
  jpeg_mem_src(&info, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
  jpeg_read_header(&info, TRUE);
  info.out_color_space = JCS_EXT_RGBA;  // CMYK can't be converted: an error
  info.dct_method = JDCT_ISLOW;         // the same bits on every machine
  jpeg_start_decompress(&info);
  bool fits = info.output_width == image.width && info.output_height == image.height;
  while (fits && info.output_scanline < info.output_height) {
    JSAMPROW row = image.rgba.data() + std::size_t{info.output_scanline} * image.width * 4;
    jpeg_read_scanlines(&info, &row, 1);
  }
  if (fits) jpeg_finish_decompress(&info);
  jpeg_destroy_decompress(&info);
  return fits && !errors.is_damaged;
}

bool isOpaque(const Image8& image) {
  for (std::size_t i = 3; i < image.rgba.size(); i += 4) {
    if (image.rgba[i] != 255) return false;
  }
  return true;
}

bool encodePngRows(const Image8& image, std::span<png_bytep> rows, bool opaque, std::vector<std::byte>& out) {
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, failPng, ignorePngWarning);
  png_infop info = png == nullptr ? nullptr : png_create_info_struct(png);
  if (info == nullptr || setjmp(png_jmpbuf(png)) != 0) {
    png_destroy_write_struct(&png, &info);
    return false;
  }
  png_set_write_fn(png, &out, writePngBytes, flushNothing);
  png_set_IHDR(png, info, image.width, image.height, 8,
               opaque ? PNG_COLOR_TYPE_RGB : PNG_COLOR_TYPE_RGB_ALPHA, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
  png_set_compression_level(png, 6);
  png_set_filter(png, 0, PNG_FILTER_SUB);
  png_write_info(png, info);
  if (opaque) png_set_filler(png, 0, PNG_FILLER_AFTER);  // drops the alpha bytes
  png_write_image(png, rows.data());
  png_write_end(png, nullptr);
  png_destroy_write_struct(&png, &info);
  return true;
}

std::vector<png_bytep> rowsOf(std::vector<std::uint8_t>& rgba, std::uint32_t width, std::uint32_t height) {
  std::vector<png_bytep> rows(height);
  for (std::size_t y = 0; y < height; ++y) rows[y] = rgba.data() + y * width * 4;
  return rows;
}

}  // namespace

void readImageHeader(std::span<const std::byte> bytes, const std::string& file, const std::string& where,
                     RawImage& image) {
  bool is_sound = false;
  if (isPng(bytes)) {
    image.mime_type = "image/png";
    // The first chunk is IHDR: length, type, width, height.
    is_sound = bytes.size() >= 33 && std::memcmp(bytes.data() + 12, "IHDR", 4) == 0;
    if (is_sound) {
      image.width = bigEndian(bytes, 16, 4);
      image.height = bigEndian(bytes, 20, 4);
    }
  } else if (isJpeg(bytes)) {
    image.mime_type = "image/jpeg";
    is_sound = findJpegSize(bytes, image);
  } else {
    throw InputError({file, where, "the image is neither PNG nor JPEG", kConvert});
  }
  if (!is_sound || image.width == 0 || image.height == 0 || image.width > 65535 || image.height > 65535) {
    throw InputError({file, where, "the image's header is damaged", kConvert});
  }
}

Image8 decodeImage(const RawImage& image, const std::string& file) {
  RawImage header;
  readImageHeader(image.bytes, file, image.name, header);
  Image8 result{header.width, header.height, {}};
  result.rgba.assign(std::size_t{result.width} * result.height * 4, 0);
  bool is_sound = false;
  if (header.mime_type == "image/png") {
    PngInput input{image.bytes.data(), image.bytes.size()};
    std::vector<png_bytep> rows = rowsOf(result.rgba, result.width, result.height);
    is_sound = decodePngRows(input, result, rows);
  } else {
    is_sound = decodeJpegRows(image.bytes, result);
  }
  if (!is_sound) throw InputError({file, image.name, "the image is damaged or of an unknown kind", kConvert});
  return result;
}

std::vector<std::byte> encodePng(const Image8& image) {
  ENSEMBLE_CHECK(image.width > 0u && image.height > 0u);
  ENSEMBLE_CHECK(image.rgba.size() == std::size_t{image.width} * image.height * 4);
  std::vector<std::uint8_t> rgba = image.rgba;  // libpng wants rows that it might write to
  std::vector<png_bytep> rows = rowsOf(rgba, image.width, image.height);
  std::vector<std::byte> out;
  const bool encoded = encodePngRows(image, rows, isOpaque(image), out);
  ENSEMBLE_CHECK(encoded);
  return out;
}

}  // namespace ensemble
