#include "sim/film/libav.h"

#include <fmt/core.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "error.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavutil/error.h>
#include <libavutil/frame.h>
#include <libavutil/log.h>
}

namespace continuum {
namespace av {

void Deleter::operator()(AVCodecContext* codec) const { avcodec_free_context(&codec); }
void Deleter::operator()(AVFrame* frame) const { av_frame_free(&frame); }
void Deleter::operator()(AVPacket* packet) const { av_packet_free(&packet); }

std::string Reason(int code) {
  std::array<char, AV_ERROR_MAX_STRING_SIZE> text{};
  av_strerror(code, text.data(), text.size());
  return text.data();
}

int Check(int code, const std::string& what) {
  if (code < 0) throw Error::Job(what + ": " + Reason(code));
  return code;
}

int CheckWritten(int code, const std::string& what) {
  for (const int file : {EACCES, EDQUOT, EFBIG, EIO, ENOENT, ENOSPC, EROFS}) {
    if (code == AVERROR(file)) throw Error::Input("", std::strerror(file));
  }
  return Check(code, what);
}

template <class T>
T* NotNull(T* object, const char* what) {
  if (!object) throw Error::Job(std::string("libav cannot allocate ") + what);
  return object;
}

Owned<AVCodecContext> NewEncoder(const char* name) {
  av_log_set_level(AV_LOG_QUIET);
  const AVCodec* const codec = avcodec_find_encoder_by_name(name);
  if (!codec) {
    throw Error::Job(fmt::format("libavcodec was built without the encoder {}", name));
  }
  return Owned<AVCodecContext>(NotNull(avcodec_alloc_context3(codec), "an encoder"));
}

Owned<AVFrame> NewFrame(const AVCodecContext& encoder) {
  Owned<AVFrame> frame(NotNull(av_frame_alloc(), "a frame"));
  frame->format = encoder.pix_fmt;
  frame->width = encoder.width;
  frame->height = encoder.height;
  Check(av_frame_get_buffer(frame.get(), 0), "memory for a frame");
  return frame;
}

void Encode(AVCodecContext& encoder, const AVFrame* frame,
            const std::function<void(AVPacket&)>& take) {
  Check(avcodec_send_frame(&encoder, frame), "encoding a frame");
  const Owned<AVPacket> packet(NotNull(av_packet_alloc(), "a packet"));
  for (;;) {
    const int code = avcodec_receive_packet(&encoder, packet.get());
    if (code == AVERROR(EAGAIN) || code == AVERROR_EOF) return;
    Check(code, "encoding a frame");
    take(*packet);
    av_packet_unref(packet.get());
  }
}

}  // namespace av

}  // namespace continuum
