#pragma once

#include <filesystem>
#include <memory>

#include "sim/film/image.h"

namespace continuum {

/// Throws Error (kInput) where a VideoWriter would for its arguments: to be asked before long work.
void RequireFilm(const std::filesystem::path& path, int width, int height, int fps);

/// Writes an H.264 film (MP4, 4:2:0, BT.709, index in front) of constant frame rate. Frame k is
/// shown from k/fps to (k+1)/fps [s].
///
/// A thread of its own encodes while the next frame is drawn. The file appears at Finish, whole;
/// without Finish nothing is left behind.
class VideoWriter {
 public:
  /// fps: frames per second, 1..1000. Throws Error (kInput) for a name that does not end in .mp4,
  /// odd sizes (4:2:0 halves both), or a path that cannot be written, (kJob) without libx264.
  VideoWriter(const std::filesystem::path& path, int width, int height, int fps);
  ~VideoWriter();
  VideoWriter(VideoWriter&&) noexcept;
  VideoWriter& operator=(VideoWriter&&) noexcept;

  /// The next frame. Throws Error when its size is another one, or when an earlier frame failed.
  void Add(Image image);

  /// Ends the film and puts it in place. Throws Error when there is no frame or writing failed.
  void Finish();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace continuum
