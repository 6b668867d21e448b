#include "sim/film/video.h"

#include <fmt/core.h>

#include <array>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <exception>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "error.h"
#include "sim/io/file.h"
#include "sim/io/output_folder.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/opt.h>
#include <libswscale/swscale.h>
}

namespace continuum {
namespace {

namespace fs = std::filesystem;

// Enough to ride out a slow frame; beyond it the drawing waits, so memory stays bounded.
constexpr std::size_t kQueue = 8;

struct MuxerDeleter {
  void operator()(AVFormatContext* muxer) const {
    avio_closep(&muxer->pb);
    avformat_free_context(muxer);
  }
};
struct ScalerDeleter {
  void operator()(SwsContext* scaler) const { sws_freeContext(scaler); }
};

// The file and its encoder, in the thread that calls.
class Film {
 public:
  Film(const fs::path& file, int width, int height, int fps) : encoder_(av::NewEncoder("libx264")) {
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

  void Add(const Image& image) {
    av::Check(av_frame_make_writable(frame_.get()), "memory for a frame");
    const std::array<const std::uint8_t*, 1> rows = {image.rgb.data()};
    const std::array<int, 1> stride = {3 * image.width};
    av::Check(sws_scale(scaler_.get(), rows.data(), stride.data(), 0, image.height, frame_->data,
                        frame_->linesize),
              "colour conversion");
    frame_->pts = frames_++;
    Write(frame_.get());
  }

  void Finish() {
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

// Removes a file unless it was moved away.
class Partial {
 public:
  explicit Partial(fs::path path) : path_(std::move(path)) {}
  ~Partial() {
    std::error_code ignored;
    fs::remove(path_, ignored);
  }
  Partial(const Partial&) = delete;
  Partial& operator=(const Partial&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

}  // namespace

void RequireFilm(const fs::path& path, int width, int height, int fps) {
  const std::string where = path.string();
  if (path.extension() != ".mp4") throw Error::Input(where, "a name that ends in .mp4", where);
  if (fs::is_directory(path)) throw Error::Input(where, "a file", "a folder");
  if (fs::is_other(path)) throw Error::Input(where, "a file", "a device");
  const auto allowed = [](int n) { return n >= 16 && n <= 8192 && n % 2 == 0; };
  if (!allowed(width) || !allowed(height)) {
    throw Error::Input(where, "an even width and height from 16 to 8192 px",
                       fmt::format("{} x {}", width, height));
  }
  if (fps < 1 || fps > 1000) {
    throw Error::Input(where, "1 to 1000 frames per second", std::to_string(fps));
  }
}

class VideoWriter::Impl {
 public:
  Impl(const fs::path& path, int width, int height, int fps)
      : path_(path),
        target_(ThroughLinks(path)),
        width_(width),
        height_(height),
        partial_(TemporaryPath(target_)) {
    try {
      film_ = std::make_unique<Film>(partial_.path(), width, height, fps);
    } catch (const Error& e) {
      throw Named(e);
    }
    thread_ = std::thread([this] { Work(); });
  }

  ~Impl() { Stop(true); }

  void Add(Image image) {
    if (image.width != width_ || image.height != height_ ||
        image.rgb.size() != 3 * static_cast<std::size_t>(width_) * height_) {
      throw Error::Input(path_.string(), fmt::format("frames of {} x {} px", width_, height_),
                         fmt::format("{} x {}", image.width, image.height));
    }
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return queue_.size() < kQueue || failure_ || stop_; });
    Rethrow();
    if (stop_) throw Error::Input(path_.string(), "no frame after the end of the film", "one");
    queue_.push_back(std::move(image));
    changed_.notify_all();
  }

  void Finish() {
    if (!thread_.joinable()) throw Error::Input(path_.string(), "one end of the film", "a second");
    Stop(false);
    Rethrow();
    try {
      film_->Finish();
    } catch (const Error& e) {
      throw Named(e);
    }
    std::error_code failed;
    fs::rename(partial_.path(), target_, failed);
    if (failed) throw Error::Input(path_.string(), "a writable file", failed.message());
  }

 private:
  Error Named(const Error& e) const {
    if (e.kind() == Error::Kind::kInput)
      return Error::Input(path_.string(), "a writable file", e.what());
    return Error::Job(path_.string() + ": " + e.what());
  }

  void Work() {
    for (;;) {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [this] { return !queue_.empty() || stop_; });
      if (queue_.empty()) return;
      const Image image = std::move(queue_.front());
      queue_.pop_front();
      changed_.notify_all();
      lock.unlock();
      try {
        film_->Add(image);
      } catch (const std::exception& e) {
        const auto* const error = dynamic_cast<const Error*>(&e);
        lock.lock();
        failure_ = Named(error ? *error : Error::Job(e.what()));
        changed_.notify_all();
        return;
      }
    }
  }

  void Stop(bool discard) {
    {
      const std::lock_guard lock(mutex_);
      stop_ = true;
      if (discard) queue_.clear();
      changed_.notify_all();
    }
    if (thread_.joinable()) thread_.join();
  }

  void Rethrow() {
    if (failure_) throw *failure_;
  }

  fs::path path_, target_;
  int width_, height_;
  Partial partial_;
  std::unique_ptr<Film> film_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Image> queue_;
  bool stop_ = false;
  std::optional<Error> failure_;
  std::thread thread_;
};

VideoWriter::VideoWriter(const fs::path& path, int width, int height, int fps) {
  RequireFilm(path, width, height, fps);
  impl_ = std::make_unique<Impl>(path, width, height, fps);
}
VideoWriter::~VideoWriter() = default;
VideoWriter::VideoWriter(VideoWriter&&) noexcept = default;
VideoWriter& VideoWriter::operator=(VideoWriter&&) noexcept = default;

void VideoWriter::Add(Image image) { impl_->Add(std::move(image)); }
void VideoWriter::Finish() { impl_->Finish(); }

}  // namespace continuum
