#include "sim/film/side_by_side.h"

#include <algorithm>
#include <exception>
#include <optional>
#include <semaphore>
#include <thread>
#include <utility>

#include "sim/film/video.h"

namespace continuum {
namespace {

// The frames of a log, one at a time. They are drawn in a thread of their own, which rests while
// nobody waits for a frame: no two threads ever simulate or draw at once.
class Frames {
 public:
  Frames(const Side& side, std::size_t log, const FilmOptions& options, const Outlook& ahead,
         Ruler& ruler)
      : thread_([this, &side, log, options, &ahead, &ruler] {
          Draw(side, log, options, ahead, ruler);
        }) {}
  ~Frames() {
    if (!ended_) {
      cancelled_ = true;
      Wait();
    }
    thread_.join();
  }
  Frames(const Frames&) = delete;

  // The next frame, nullopt after the last. Throws what drawing threw.
  std::optional<Image> Next() {
    if (!ended_) Wait();
    if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
    return std::exchange(image_, std::nullopt);
  }

 private:
  struct Cancelled {};

  void Wait() {
    wanted_.release();
    ready_.acquire();
  }

  void Await() {
    wanted_.acquire();
    if (cancelled_) throw Cancelled();
  }

  void Draw(const Side& side, std::size_t log, FilmOptions options, const Outlook& ahead,
            Ruler& ruler) {
    try {
      Await();
      options.caption = side.name;
      if (side.labelled) options.caption += ": " + side.experiment.logs[log].label;
      DrawFrames(side.experiment, side.system, side.experiment.logs[log], options, ahead, ruler,
                 [&](Image image) {
                   image_ = std::move(image);
                   ready_.release();
                   Await();
                 });
    } catch (const Cancelled&) {
    } catch (...) {
      error_ = std::current_exception();
    }
    ended_ = true;
    ready_.release();
  }

  std::binary_semaphore wanted_{0}, ready_{0};
  bool cancelled_ = false, ended_ = false;
  std::optional<Image> image_;
  std::exception_ptr error_;
  std::thread thread_;
};

Image Joined(const Image& left, const Image& right) {
  Image both{left.width + right.width, left.height, {}};
  for (int y = 0; y < left.height; ++y) {
    for (const Image* image : {&left, &right}) {
      const auto row = image->rgb.begin() + 3 * y * image->width;
      both.rgb.insert(both.rgb.end(), row, row + 3 * image->width);
    }
  }
  return both;
}

}  // namespace

void DrawSideBySide(const Side& left, const Side& right, std::size_t log,
                    const FilmOptions& options, const std::function<void(Image)>& take) {
  const auto look = [&](const Side& side) {
    return LookAhead(side.experiment, side.system, side.experiment.logs[log], options);
  };
  Outlook ahead = look(left), beside = look(right);
  ahead.Include(beside);
  beside.Include(ahead);
  Ruler ruler;
  Frames one(left, log, options, ahead, ruler), other(right, log, options, beside, ruler);
  Image frames[2];
  for (;;) {
    std::optional<Image> next[2] = {one.Next(), other.Next()};
    if (!next[0] && !next[1]) return;
    for (int i = 0; i < 2; ++i) {
      if (next[i]) frames[i] = *std::move(next[i]);
    }
    take(Joined(frames[0], frames[1]));
  }
}

void FilmSideBySide(const Side& left, const Side& right, const std::vector<std::size_t>& logs,
                    const std::filesystem::path& file, const FilmOptions& options) {
  VideoWriter video(file, 2 * options.width, options.height, options.fps);
  std::size_t done = 0;
  for (const std::size_t l : logs) {
    if (options.progress)
      options.progress({"film", done++, logs.size(), left.experiment.logs[l].label});
    DrawSideBySide(left, right, l, options, [&](Image image) { video.Add(std::move(image)); });
  }
  video.Finish();
}

}  // namespace continuum
