#include "sim/film/video.h"

#include <fmt/core.h>

#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "error.h"
#include "sim/film/film_file.h"
#include "sim/io/file.h"
#include "sim/io/output_folder.h"

namespace continuum {
namespace {

namespace fs = std::filesystem;

// Enough to ride out a slow frame; beyond it the drawing waits, so memory stays bounded.
constexpr std::size_t kQueue = 8;

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
      film_ = NewFilmFile(partial_.path(), width, height, fps);
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
  std::unique_ptr<FilmFile> film_;
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
