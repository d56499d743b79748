// Videos, read back through FFmpeg's own demuxer and decoder.
#include "renderer/video_writer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
}

#include <array>
#include <cmath>

#include "core/atomic_file.h"
#include "core/check.h"
#include "core/input_error.h"
#include "tests/support/temporary_folder.h"

namespace ensemble {
namespace {

using Yuv = std::array<int, 3>;

/// A video's properties, and each frame's samples at its middle.
struct ReadVideo {
  int width = 0, height = 0;
  double fps = 0.0, seconds = 0.0;
  AVRational rate{};
  AVCodecID codec = AV_CODEC_ID_NONE;
  AVColorSpace matrix = AVCOL_SPC_UNSPECIFIED;
  AVColorRange range = AVCOL_RANGE_UNSPECIFIED;
  AVPixelFormat format = AV_PIX_FMT_NONE;
  std::vector<Yuv> middles;
  std::vector<std::int64_t> times;  ///< of the frames, in frames
};

void decode(AVCodecContext* decoder, const AVPacket* packet, const AVStream* stream, ReadVideo& video) {
  ASSERT_GE(avcodec_send_packet(decoder, packet), 0);
  AVFrame* frame = av_frame_alloc();
  while (avcodec_receive_frame(decoder, frame) >= 0) {
    video.format = static_cast<AVPixelFormat>(frame->format);
    const int x = frame->width / 2, y = frame->height / 2;
    video.middles.push_back({frame->data[0][y * frame->linesize[0] + x],
                             frame->data[1][y / 2 * frame->linesize[1] + x / 2],
                             frame->data[2][y / 2 * frame->linesize[2] + x / 2]});
    video.times.push_back(av_rescale_q(frame->pts, stream->time_base, av_inv_q(video.rate)));
  }
  av_frame_free(&frame);
}

ReadVideo readVideo(const std::filesystem::path& file) {
  ReadVideo video;
  AVFormatContext* format = nullptr;
  if (avformat_open_input(&format, file.c_str(), nullptr, nullptr) < 0) return video;
  EXPECT_GE(avformat_find_stream_info(format, nullptr), 0);
  EXPECT_EQ(format->nb_streams, 1u);
  const AVStream* stream = format->streams[0];
  const AVCodecParameters& codec = *stream->codecpar;
  video.width = codec.width;
  video.height = codec.height;
  video.codec = codec.codec_id;
  video.matrix = codec.color_space;
  video.range = codec.color_range;
  video.rate = stream->avg_frame_rate;
  video.seconds = static_cast<double>(stream->duration) * av_q2d(stream->time_base);
  AVCodecContext* decoder = avcodec_alloc_context3(avcodec_find_decoder(codec.codec_id));
  EXPECT_GE(avcodec_parameters_to_context(decoder, &codec), 0);
  EXPECT_GE(avcodec_open2(decoder, nullptr, nullptr), 0);
  AVPacket* packet = av_packet_alloc();
  while (av_read_frame(format, packet) >= 0) {
    decode(decoder, packet, stream, video);
    av_packet_unref(packet);
  }
  decode(decoder, nullptr, stream, video);
  av_packet_free(&packet);
  avcodec_free_context(&decoder);
  avformat_close_input(&format);
  return video;
}

Image8 plain(std::uint32_t width, std::uint32_t height, std::array<std::uint8_t, 4> color) {
  Image8 image{width, height, {}};
  for (std::uint32_t i = 0; i < width * height; ++i) {
    image.rgba.insert(image.rgba.end(), color.begin(), color.end());
  }
  return image;
}

/// ITU-R BT.709, limited range.
Yuv bt709(const std::array<std::uint8_t, 4>& rgba) {
  const double r = rgba[0] / 255.0, g = rgba[1] / 255.0, b = rgba[2] / 255.0;
  const double y = 0.2126 * r + 0.7152 * g + 0.0722 * b;
  const auto rounded = [](double value) { return static_cast<int>(std::lround(value)); };
  return {rounded(16 + 219 * y), rounded(128 + 224 * (b - y) / 1.8556),
          rounded(128 + 224 * (r - y) / 1.5748)};
}

constexpr std::array<std::array<std::uint8_t, 4>, 6> kColors = {{{255, 255, 255, 255},
                                                                 {0, 0, 0, 255},
                                                                 {200, 30, 40, 255},
                                                                 {20, 180, 60, 255},
                                                                 {51, 102, 204, 255},
                                                                 {128, 128, 128, 255}}};

void writeColors(const std::filesystem::path& file, FrameRate rate) {
  VideoWriter video(file, 66, 34, rate);
  for (const auto& color : kColors) video.add(plain(66, 34, color));
  video.finish();
}

TEST(VideoWriter, HoldsItsFramesWithTheirColours) {
  const testing::TemporaryFolder folder;
  writeColors(folder / "a.mp4", {2997, 100});
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
  const ReadVideo video = readVideo(folder / "a.mp4");
  EXPECT_EQ(video.width, 66);
  EXPECT_EQ(video.height, 34);
  EXPECT_EQ(video.codec, AV_CODEC_ID_H264);
  EXPECT_EQ(video.format, AV_PIX_FMT_YUV420P);
  EXPECT_EQ(video.matrix, AVCOL_SPC_BT709);
  EXPECT_EQ(video.range, AVCOL_RANGE_MPEG);
  EXPECT_EQ(video.rate.num, 2997);
  EXPECT_EQ(video.rate.den, 100);
  EXPECT_NEAR(video.seconds, 6 / 29.97, 1e-3);
  EXPECT_THAT(video.times, ::testing::ElementsAre(0, 1, 2, 3, 4, 5));
  ASSERT_EQ(video.middles.size(), kColors.size());
  for (std::size_t i = 0; i < kColors.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(video.middles[i][k], bt709(kColors[i])[k], 2) << "frame " << i << ", plane " << k;
    }
  }
}

TEST(VideoWriter, TheSameFramesAreTheSameBytes) {
  const testing::TemporaryFolder folder;
  writeColors(folder / "a.mp4", {});
  writeColors(folder / "b.mp4", {});
  EXPECT_EQ(readFile(folder / "a.mp4"), readFile(folder / "b.mp4"));
}

TEST(VideoWriter, LeavesNothingBehindUnlessFinished) {
  const testing::TemporaryFolder folder;
  writeFileAtomically(folder / "a.mp4", std::string_view("old"));
  {
    VideoWriter video(folder / "a.mp4", 32, 32, {});
    for (int i = 0; i < 100; ++i) video.add(plain(32, 32, kColors[i % kColors.size()]));
    EXPECT_EQ(readFile(folder / "a.mp4").size(), 3u);
  }
  EXPECT_EQ(readFile(folder / "a.mp4").size(), 3u);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

TEST(VideoWriter, ChecksItsCaller) {
  const testing::TemporaryFolder folder;
  EXPECT_THROW(VideoWriter(folder / "a.mp4", 31, 32, {}), CheckError);
  EXPECT_THROW(VideoWriter(folder / "a.mp4", 0, 32, {}), CheckError);
  VideoWriter video(folder / "a.mp4", 32, 32, {});
  EXPECT_THROW(video.add(plain(32, 16, kColors[0])), CheckError);
}

TEST(VideoWriter, SaysWhereItCantWrite) {
  const testing::TemporaryFolder folder;
  const std::string file = (folder / "none" / "a.mp4").string();
  try {
    const VideoWriter video(file, 32, 32, {});
    FAIL();
  } catch (const SystemError& error) {
    EXPECT_EQ(error.what(), file + ": can't be written: No such file or directory; make its folder first");
  }
}

TEST(FrameRate, IsTheDecimalThatWasWritten) {
  EXPECT_EQ(frameRateOf(30.0f), (FrameRate{30, 1}));
  EXPECT_EQ(frameRateOf(29.97f), (FrameRate{2997, 100}));
  EXPECT_EQ(frameRateOf(23.976f), (FrameRate{2997, 125}));
  EXPECT_EQ(frameRateOf(59.94f), (FrameRate{2997, 50}));
  EXPECT_EQ(frameRateOf(24.5f), (FrameRate{49, 2}));
  EXPECT_EQ(frameRateOf(0.1f), (FrameRate{1, 10}));
  EXPECT_EQ(frameRateOf(1000.0f), (FrameRate{1000, 1}));
}

TEST(CheckVideo, RefusesWhatH264CantHold) {
  const auto message = [](const SceneOutput& output) -> std::string {
    try {
      checkVideo("a.mp4", output);
    } catch (const UsageError& error) {
      return error.what();
    }
    return "fine";
  };
  EXPECT_EQ(message({.width = 66, .height = 34}), "fine");
  EXPECT_EQ(message({.width = 65, .height = 33}),
            "-o a.mp4: a video of 65 x 33 pixels can't be made, its sides must be even; write --set "
            "output.width=66 --set output.height=34");
  EXPECT_EQ(message({.width = 66, .height = 34, .background = BackgroundKind::kTransparent}),
            "-o a.mp4: a video has no transparency; write name_%04d.png or .exr, or --set "
            "output.background=sky");
}

}  // namespace
}  // namespace ensemble
