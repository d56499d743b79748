#include "renderer/video_writer.h"

#include <fmt/format.h>

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/opt.h>
#include <libswscale/swscale.h>
}

#include <array>
#include <cerrno>
#include <cstdlib>

#include "core/atomic_file.h"
#include "core/check.h"
#include "core/input_error.h"

namespace ensemble {
namespace {

constexpr const char* kEncoder = "libx264";
constexpr const char* kQuality = "18";  // hardly to be told from the pictures; crf counts from 0 to 51
constexpr int kLargestTerm = 10'000'000;

template <auto Free>
struct Freed {
  template <class T>
  void operator()(T* object) const {
    Free(&object);
  }
};
using FramePointer = std::unique_ptr<AVFrame, Freed<av_frame_free>>;
using PacketPointer = std::unique_ptr<AVPacket, Freed<av_packet_free>>;
using CodecPointer = std::unique_ptr<AVCodecContext, Freed<avcodec_free_context>>;

struct FormatFreed {
  void operator()(AVFormatContext* format) const {
    if (format->pb) avio_closep(&format->pb);
    avformat_free_context(format);
  }
};
struct ScalerFreed {
  void operator()(SwsContext* scaler) const { sws_freeContext(scaler); }
};

/// Calls of FFmpeg that must not fail, on behalf of a file.
class Calls {
 public:
  explicit Calls(const std::filesystem::path& file) : file_(file.string()) {
    av_log_set_level(AV_LOG_QUIET);  // a library prints nothing
  }

  /// @param what the WHAT of "FFmpeg can't WHAT: reason"
  void check(int result, const char* what) const {
    if (result >= 0) return;
    std::array<char, AV_ERROR_MAX_STRING_SIZE> reason{};
    av_strerror(result, reason.data(), reason.size());
    if (result == AVERROR(ENOSPC) || result == AVERROR(EDQUOT)) {
      throw SystemError(
          {file_, "", std::string("can't be written: ") + reason.data(), "free some space and run it again"});
    }
    throw SystemError({file_, "", fmt::format("FFmpeg can't {}: {}", what, reason.data()),
                       "write name_%04d.png instead, and make the video of them"});
  }
  template <class T>
  T* checkMade(T* object, const char* what) const {
    if (!object) check(AVERROR(ENOMEM), what);
    return object;
  }
  const std::string& file() const { return file_; }

 private:
  std::string file_;
};

const AVCodec& findEncoder(const Calls& calls) {
  const AVCodec* codec = avcodec_find_encoder_by_name(kEncoder);
  if (codec) return *codec;
  throw SystemError({calls.file(), "", fmt::format("this FFmpeg has no H.264 encoder {}", kEncoder),
                     "install Debian's libavcodec59, or write name_%04d.png instead"});
}

CodecPointer openEncoder(const Calls& calls, int width, int height, FrameRate rate, bool global_header) {
  const AVCodec& codec = findEncoder(calls);
  CodecPointer encoder(calls.checkMade(avcodec_alloc_context3(&codec), "make an encoder"));
  encoder->width = width;
  encoder->height = height;
  encoder->pix_fmt = AV_PIX_FMT_YUV420P;
  encoder->time_base = {rate.denominator, rate.numerator};
  encoder->framerate = {rate.numerator, rate.denominator};
  encoder->colorspace = AVCOL_SPC_BT709;
  encoder->color_primaries = AVCOL_PRI_BT709;
  encoder->color_trc = AVCOL_TRC_BT709;
  encoder->color_range = AVCOL_RANGE_MPEG;
  encoder->chroma_sample_location = AVCHROMA_LOC_LEFT;
  encoder->thread_count = 1;  // the bytes depend on the number of threads
  encoder->flags |= AV_CODEC_FLAG_BITEXACT;
  if (global_header) encoder->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
  calls.check(av_opt_set(encoder->priv_data, "crf", kQuality, 0), "set the quality of H.264");
  calls.check(avcodec_open2(encoder.get(), &codec, nullptr),
              fmt::format("encode {} x {} pixels as H.264", width, height).c_str());
  return encoder;
}

/// From full-range RGB to the encoder's kind, with its chroma samples where the tags say.
SwsContext* makeScaler(const Calls& calls, int width, int height) {
  SwsContext* const scaler = calls.checkMade(sws_alloc_context(), "make a colour conversion");
  const auto set = [&](const char* name, int value) {
    calls.check(av_opt_set_int(scaler, name, value, 0), "set up its colour conversion");
  };
  set("srcw", width);
  set("srch", height);
  set("src_format", AV_PIX_FMT_RGB0);
  set("dstw", width);
  set("dsth", height);
  set("dst_format", AV_PIX_FMT_YUV420P);
  set("dst_h_chr_pos", 0);
  set("dst_v_chr_pos", 128);
  set("sws_flags", SWS_BICUBIC | SWS_ACCURATE_RND | SWS_FULL_CHR_H_INP | SWS_BITEXACT);
  const int* const bt709 = sws_getCoefficients(SWS_CS_ITU709);
  sws_setColorspaceDetails(scaler, bt709, 1, bt709, 0, 0, 1 << 16, 1 << 16);
  calls.check(sws_init_context(scaler, nullptr, nullptr), "set up its colour conversion");
  return scaler;
}

}  // namespace

FrameRate frameRateOf(float fps) {
  ENSEMBLE_CHECK(fps > 0.0f);
  // The shortest text that reads back as this float is what the user wrote.
  const AVRational rate = av_d2q(std::strtod(fmt::format("{}", fps).c_str(), nullptr), kLargestTerm);
  return {rate.num, rate.den};
}

void checkVideo(const std::string& output, const SceneOutput& scene) {
  if (scene.background == BackgroundKind::kTransparent) {
    throw UsageError({"", "-o " + output, "a video has no transparency",
                      "write name_%04d.png or .exr, or --set output.background=sky"});
  }
  if (scene.width % 2 == 0 && scene.height % 2 == 0) return;
  throw UsageError({"", "-o " + output,
                    fmt::format("a video of {} x {} pixels can't be made, its sides must be even",
                                scene.width, scene.height),
                    fmt::format("write --set output.width={} --set output.height={}",
                                scene.width + scene.width % 2, scene.height + scene.height % 2)});
}

// Members refer to those above them.
struct VideoWriter::Impl {
  Impl(const std::filesystem::path& file, int width, int height, FrameRate rate) : calls(file), aside(file) {
    const std::string url = "file:" + aside.aside().string();
    AVFormatContext* made = nullptr;
    calls.check(avformat_alloc_output_context2(&made, nullptr, "mp4", url.c_str()), "write MP4");
    format.reset(made);
    format->flags |= AVFMT_FLAG_BITEXACT;
    encoder = openEncoder(calls, width, height, rate, (format->oformat->flags & AVFMT_GLOBALHEADER) != 0);
    scaler.reset(makeScaler(calls, width, height));
    frame.reset(calls.checkMade(av_frame_alloc(), "make a frame"));
    frame->format = encoder->pix_fmt;
    frame->width = width;
    frame->height = height;
    calls.check(av_frame_get_buffer(frame.get(), 0), "make a frame");
    packet.reset(calls.checkMade(av_packet_alloc(), "make a packet"));
    stream = calls.checkMade(avformat_new_stream(format.get(), nullptr), "write MP4");
    calls.check(avcodec_parameters_from_context(stream->codecpar, encoder.get()), "write MP4");
    stream->time_base = encoder->time_base;
    stream->avg_frame_rate = encoder->framerate;
    calls.check(avio_open(&format->pb, url.c_str(), AVIO_FLAG_WRITE), "write MP4");
    AVDictionary* options = nullptr;
    av_dict_set(&options, "movflags", "+faststart", 0);  // the index in front, for the web
    const int result = avformat_write_header(format.get(), &options);
    av_dict_free(&options);
    calls.check(result, "write MP4");
  }

  /// @param picture null: the end
  void encode(const AVFrame* picture) {
    calls.check(avcodec_send_frame(encoder.get(), picture), "encode H.264");
    for (;;) {
      const int result = avcodec_receive_packet(encoder.get(), packet.get());
      if (result == AVERROR(EAGAIN) || result == AVERROR_EOF) return;
      calls.check(result, "encode H.264");
      packet->duration = 1;
      av_packet_rescale_ts(packet.get(), encoder->time_base, stream->time_base);
      packet->stream_index = stream->index;
      calls.check(av_interleaved_write_frame(format.get(), packet.get()), "write MP4");
    }
  }

  Calls calls;
  FileAside aside;
  std::unique_ptr<AVFormatContext, FormatFreed> format;
  CodecPointer encoder;
  std::unique_ptr<SwsContext, ScalerFreed> scaler;
  FramePointer frame;
  PacketPointer packet;
  AVStream* stream = nullptr;  ///< of the format
  std::int64_t frame_count = 0;
};

VideoWriter::VideoWriter(const std::filesystem::path& file, std::uint32_t width, std::uint32_t height,
                         FrameRate rate) {
  ENSEMBLE_CHECK(width % 2 == 0u && height % 2 == 0u);
  ENSEMBLE_CHECK(width > 0u && height > 0u);
  impl_ = std::make_unique<Impl>(file, static_cast<int>(width), static_cast<int>(height), rate);
}

VideoWriter::~VideoWriter() = default;

void VideoWriter::add(const Image8& picture) {
  AVFrame& frame = *impl_->frame;
  ENSEMBLE_CHECK(static_cast<int>(picture.width) == frame.width);
  ENSEMBLE_CHECK(static_cast<int>(picture.height) == frame.height);
  impl_->calls.check(av_frame_make_writable(&frame), "make a frame");
  const std::uint8_t* const rows[] = {picture.rgba.data()};
  const int strides[] = {4 * frame.width};
  impl_->calls.check(
      sws_scale(impl_->scaler.get(), rows, strides, 0, frame.height, frame.data, frame.linesize),
      "convert a frame");
  frame.pts = impl_->frame_count++;
  impl_->encode(&frame);
}

void VideoWriter::finish() {
  impl_->encode(nullptr);
  impl_->calls.check(av_write_trailer(impl_->format.get()), "write MP4");
  impl_->calls.check(avio_closep(&impl_->format->pb), "write MP4");
  impl_->aside.commit();
}

}  // namespace ensemble
