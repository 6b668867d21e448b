#include <array>
#include <cstdint>

#include "error.h"
#include "sim/film/film_file.h"
#include "sim/film/libav.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/opt.h>
#include <libswscale/swscale.h>
}

namespace continuum {
namespace {

namespace fs = std::filesystem;

struct MuxerDeleter {
  void operator()(AVFormatContext* muxer) const {
    avio_closep(&muxer->pb);
    avformat_free_context(muxer);
  }
};
struct ScalerDeleter {
  void operator()(SwsContext* scaler) const { sws_freeContext(scaler); }
};

// The file and its encoder.
class LibavFilm : public FilmFile {
 public:
  LibavFilm(const fs::path& file, int width, int height, int fps)
      : encoder_(av::NewEncoder("libx264")) {
    OpenFile(file);
    OpenEncoder(width, height, fps);
    OpenScaler();
    stream_ = avformat_new_stream(muxer_.get(), nullptr);
    if (!stream_) throw Error::Job("libav cannot allocate a stream");
    stream_->time_base = encoder_->time_base;
    stream_->avg_frame_rate = encoder_->framerate;
    av::Check(avcodec_parameters_from_context(stream_->codecpar, encoder_.get()), "H.264 stream");
    AVDictionary* options = nullptr;
    int code = av_dict_set(&options, "movflags", "+faststart", 0);
    if (code >= 0) code = avformat_write_header(muxer_.get(), &options);
    av_dict_free(&options);
    av::CheckWritten(code, "MP4 header");
  }

  void Add(const Image& image) override {
    av::Check(av_frame_make_writable(frame_.get()), "memory for a frame");
    const std::array<const std::uint8_t*, 1> rows = {image.rgb.data()};
    const std::array<int, 1> stride = {3 * image.width};
    av::Check(sws_scale(scaler_.get(), rows.data(), stride.data(), 0, image.height, frame_->data,
                        frame_->linesize),
              "colour conversion");
    frame_->pts = frames_++;
    Write(frame_.get());
  }

  void Finish() override {
    if (frames_ == 0) throw Error::Job("a film needs at least one frame");
    Write(nullptr);
    av::CheckWritten(av_write_trailer(muxer_.get()), "MP4 index");
    av::CheckWritten(avio_closep(&muxer_->pb), "closing the film");
  }

 private:
  void OpenFile(const fs::path& file) {
    AVFormatContext* muxer = nullptr;
    av::Check(avformat_alloc_output_context2(&muxer, nullptr, "mp4", file.c_str()), "MP4 writer");
    muxer_.reset(muxer);
    const int code = avio_open(&muxer->pb, file.c_str(), AVIO_FLAG_WRITE);
    if (code < 0) throw Error::Input("", av::Reason(code));
  }

  void OpenEncoder(int width, int height, int fps) {
    encoder_->width = width;
    encoder_->height = height;
    encoder_->pix_fmt = AV_PIX_FMT_YUV420P;
    encoder_->time_base = {1, fps};
    encoder_->framerate = {fps, 1};
    encoder_->color_range = AVCOL_RANGE_MPEG;
    encoder_->colorspace = AVCOL_SPC_BT709;
    encoder_->color_primaries = AVCOL_PRI_BT709;
    encoder_->color_trc = AVCOL_TRC_BT709;
    encoder_->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;  // MP4 keeps it in the index
    av::Check(av_opt_set(encoder_->priv_data, "crf", "18", 0), "quality");
    av::Check(av_opt_set(encoder_->priv_data, "preset", "superfast", 0), "preset");
    av::Check(avcodec_open2(encoder_.get(), nullptr, nullptr), "H.264 encoder");
    frame_ = av::NewFrame(*encoder_);
  }

  void OpenScaler() {
    const int w = encoder_->width, h = encoder_->height;
    scaler_.reset(sws_getContext(w, h, AV_PIX_FMT_RGB24, w, h, AV_PIX_FMT_YUV420P, SWS_BILINEAR,
                                 nullptr, nullptr, nullptr));
    if (!scaler_) throw Error::Job("libswscale cannot convert RGB to 4:2:0");
    const int* const bt709 = sws_getCoefficients(SWS_CS_ITU709);
    av::Check(sws_setColorspaceDetails(scaler_.get(), bt709, 1, bt709, 0, 0, 1 << 16, 1 << 16),
              "colour conversion");
  }

  void Write(const AVFrame* frame) {
    av::Encode(*encoder_, frame, [this](AVPacket& packet) {
      packet.duration = 1;
      packet.stream_index = stream_->index;
      av_packet_rescale_ts(&packet, encoder_->time_base, stream_->time_base);
      av::CheckWritten(av_interleaved_write_frame(muxer_.get(), &packet), "writing a frame");
    });
  }

  av::Owned<AVCodecContext> encoder_;
  av::Owned<AVFrame> frame_;
  std::unique_ptr<AVFormatContext, MuxerDeleter> muxer_;
  std::unique_ptr<SwsContext, ScalerDeleter> scaler_;
  AVStream* stream_ = nullptr;
  std::int64_t frames_ = 0;
};

}  // namespace

std::unique_ptr<FilmFile> NewLibavFilm(const fs::path& file, int width, int height, int fps) {
  return std::make_unique<LibavFilm>(file, width, height, fps);
}

}  // namespace continuum
