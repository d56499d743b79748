// .gltf files, and what they may name: data URIs and files in their own folder, nothing else.
#include <gtest/gtest.h>

#include <unistd.h>

#include <fstream>

#include "core/gltf_file.h"
#include "core/input_error.h"
#include "tests/core/glb_builder.h"

namespace ensemble {
namespace {

using testing::TestGlb;
using testing::triangleGlb;

RawAsset read(const TestGlb& glb, const GltfReadOptions& options = {}) {
  return readGlb(glb.bytes(), "x.glb", options);
}

RawPrimitive readTriangle(const TestGlb& glb) { return read(glb).meshes.at(0).primitives.at(0); }

// Files on disk.

class GltfFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    root_ = std::filesystem::temp_directory_path() /
            (std::string("ensemble_gltf_") + info->name() + "_" + std::to_string(::getpid()));
    std::filesystem::create_directories(root_ / "asset" / "sub");
  }
  void TearDown() override { std::filesystem::remove_all(root_); }

  std::filesystem::path folder() const { return root_ / "asset"; }

  static void put(const std::filesystem::path& file, const void* data, std::size_t size) {
    std::ofstream(file, std::ios::binary)
        .write(static_cast<const char*>(data), static_cast<std::streamsize>(size));
  }

  // The textured triangle as .gltf, its buffer under `uri`.
  std::filesystem::path putGltf(const std::string& uri) const {
    TestGlb glb = triangleGlb();
    glb.json["buffers"] = {{{"byteLength", glb.bin.size()}, {"uri", uri}}};
    const std::string text = glb.json.dump();
    put(folder() / "x.gltf", text.data(), text.size());
    return folder() / "x.gltf";
  }

  std::string refusal(const std::string& uri) const {
    const std::filesystem::path file = putGltf(uri);
    try {
      readGltf(file);
    } catch (const InputError& error) {
      EXPECT_EQ(error.text().where, "/buffers/0/uri");
      return error.text().what;
    }
    return "accepted";
  }

  std::filesystem::path root_;
};

TEST_F(GltfFiles, BuffersBesideAndBelow) {
  const TestGlb glb = triangleGlb();
  put(folder() / "data.bin", glb.bin.data(), glb.bin.size());
  put(folder() / "sub" / "a b.bin", glb.bin.data(), glb.bin.size());
  const RawPrimitive expected = readTriangle(glb);
  EXPECT_EQ(readGltf(putGltf("data.bin")).meshes[0].primitives[0], expected);
  EXPECT_EQ(readGltf(putGltf("./sub/a%20b.bin")).meshes[0].primitives[0], expected);
}

TEST_F(GltfFiles, DataUri) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const TestGlb glb = triangleGlb();
  std::string base64;
  for (std::size_t i = 0; i < glb.bin.size(); i += 3) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      bits = bits << 8 | (i + k < glb.bin.size() ? std::to_integer<std::uint32_t>(glb.bin[i + k]) : 0);
    }
    for (int shift = 18; shift >= 0; shift -= 6) base64 += kDigits[bits >> shift & 63u];
  }
  for (std::size_t i = 0; i < (3 - glb.bin.size() % 3) % 3; ++i) base64[base64.size() - 1 - i] = '=';
  const auto file = putGltf("data:application/octet-stream;base64," + base64);
  EXPECT_EQ(readGltf(file).meshes[0].primitives[0], readTriangle(glb));
  EXPECT_EQ(refusal("data:application/octet-stream,hello"), "the data URI is not base64");
  EXPECT_EQ(refusal("data:;base64,AA*A"), "the data URI has a character that is not base64");
  EXPECT_EQ(refusal("data:;base64,A"), "the data URI ends inside a base64 group");
}

TEST_F(GltfFiles, NothingOutsideTheFolder) {
  const TestGlb glb = triangleGlb();
  put(root_ / "secret.bin", glb.bin.data(), glb.bin.size());
  std::filesystem::create_symlink(root_ / "secret.bin", folder() / "link.bin");
  std::filesystem::create_symlink(root_, folder() / "out");
  std::filesystem::create_directories(root_ / "asset2");
  put(root_ / "asset2" / "x.bin", glb.bin.data(), glb.bin.size());
  EXPECT_EQ(refusal("../secret.bin"), "'../secret.bin' leads out of the file's folder");
  EXPECT_EQ(refusal("sub/../../secret.bin"), "'sub/../../secret.bin' leads out of the file's folder");
  EXPECT_EQ(refusal("%2e%2e/secret.bin"), "'%2e%2e/secret.bin' leads out of the file's folder");
  EXPECT_EQ(refusal("..%2fsecret.bin"), "'..%2fsecret.bin' hides a '/'");
  EXPECT_EQ(refusal("..%5csecret.bin"), "'..%5csecret.bin' has a backslash");
  EXPECT_EQ(refusal("..\\secret.bin"), "'..\\secret.bin' has a backslash");
  EXPECT_EQ(refusal("/etc/passwd"), "'/etc/passwd' is an absolute path");
  EXPECT_EQ(refusal("%2fetc/passwd"), "'%2fetc/passwd' hides a '/'");
  EXPECT_EQ(refusal("file:///etc/passwd"), "'file:///etc/passwd' is not a relative path");
  EXPECT_EQ(refusal("http://example.com/x"), "'http://example.com/x' is not a relative path");
  EXPECT_EQ(refusal("link.bin"), "'link.bin' leads out of the file's folder");
  EXPECT_EQ(refusal("out/secret.bin"), "'out/secret.bin' leads out of the file's folder");
  EXPECT_EQ(refusal("out/asset2/x.bin"), "'out/asset2/x.bin' leads out of the file's folder");
  EXPECT_EQ(refusal("sub"), "'sub' is not a regular file");
  EXPECT_EQ(refusal("none.bin"), "'none.bin' can't be found");
  EXPECT_EQ(refusal("a%00.bin"), "'a%00.bin' has a control character");
  EXPECT_EQ(refusal("a%zz.bin"), "'a%zz.bin' has a '%' that no two hex digits follow");
  EXPECT_EQ(refusal("a%2"), "'a%2' has a '%' that no two hex digits follow");
  EXPECT_EQ(refusal(""), "the URI is empty");
}

TEST_F(GltfFiles, TheSumOfFilesIsLimited) {
  const TestGlb glb = triangleGlb();
  put(folder() / "data.bin", glb.bin.data(), glb.bin.size());
  const auto file = putGltf("data.bin");
  GltfReadOptions options;
  options.max_file_bytes = std::filesystem::file_size(file);
  nlohmann::json json = glb.json;
  json["buffers"] = nlohmann::json::array();
  for (int i = 0; i < 40; ++i) json["buffers"].push_back({{"byteLength", 78}, {"uri", "data.bin"}});
  const std::string text = json.dump();
  put(file, text.data(), text.size());
  options.max_file_bytes = text.size();
  ASSERT_LT(options.max_file_bytes, 40u * 78u);
  try {
    readGltf(file, options);
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_EQ(error.text().what,
              "the files named add up to more than " + std::to_string(text.size()) + " bytes");
  }
}

TEST_F(GltfFiles, NotGltfAtAll) {
  put(folder() / "x.gltf", "hello", 5);
  try {
    readGltf(folder() / "x.gltf");
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_EQ(error.text().what, "this is neither a GLB nor a .gltf");
  }
}

}  // namespace
}  // namespace ensemble
