#include "sim/film/film_file.h"

#include <cstdlib>

namespace continuum {

std::unique_ptr<FilmFile> NewFilmFile(const std::filesystem::path& file, int width, int height,
                                      int fps) {
#ifdef CONTINUUM_LIBAV
  if (!std::getenv("CONTINUUM_FFMPEG")) return NewLibavFilm(file, width, height, fps);
#endif
  return NewProgramFilm(file, width, height, fps);
}

}  // namespace continuum
