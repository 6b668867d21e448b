#pragma once

#include <filesystem>
#include <memory>

#include "sim/film/image.h"

namespace continuum {

/// A film that is being written, in the thread that calls. What it throws does not name the file:
/// Error of kInput with the bare reason where the file is to blame, else of kJob.
class FilmFile {
 public:
  virtual ~FilmFile() = default;
  virtual void Add(const Image& image) = 0;
  /// Throws Error too when there was no frame.
  virtual void Finish() = 0;
};

/// Begins an H.264 film: VideoWriter says what is in it. Encoded by libav where that is built in,
/// but by the program that the environment variable CONTINUUM_FFMPEG names where it is set; without
/// libav by `ffmpeg` of the PATH.
std::unique_ptr<FilmFile> NewFilmFile(const std::filesystem::path& file, int width, int height,
                                      int fps);
std::unique_ptr<FilmFile> NewLibavFilm(const std::filesystem::path& file, int width, int height,
                                       int fps);
std::unique_ptr<FilmFile> NewProgramFilm(const std::filesystem::path& file, int width, int height,
                                         int fps);

}  // namespace continuum
