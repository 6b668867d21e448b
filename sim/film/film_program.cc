#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "error.h"
#include "sim/film/film_file.h"

namespace continuum {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> CommandFor(const fs::path& file, int width, int height, int fps) {
  const char* const program = std::getenv("CONTINUUM_FFMPEG");
  const std::string size = std::to_string(width) + "x" + std::to_string(height);
  return {program ? program : "ffmpeg",
          "-loglevel",
          "error",
          "-y",
          "-f",
          "rawvideo",
          "-pix_fmt",
          "rgb24",
          "-s",
          size,
          "-r",
          std::to_string(fps),
          "-i",
          "-",
          "-vf",
          "scale=out_color_matrix=bt709:out_range=tv",
          "-c:v",
          "libx264",
          "-crf",
          "18",
          "-preset",
          "superfast",
          "-pix_fmt",
          "yuv420p",
          "-color_range",
          "tv",
          "-colorspace",
          "bt709",
          "-color_primaries",
          "bt709",
          "-color_trc",
          "bt709",
          "-movflags",
          "+faststart",
          "-f",
          "mp4",
          file.string()};
}

// Frames go to the program's standard input.
class ProgramFilm : public FilmFile {
 public:
  explicit ProgramFilm(std::vector<std::string> command) : name_(command.front()) {
    std::signal(SIGPIPE, SIG_IGN);  // a program that ends early fails where it is written to
    std::vector<char*> words;
    for (std::string& word : command) words.push_back(word.data());
    words.push_back(nullptr);
    int ends[2];
    if (pipe(ends) != 0) throw Error::Job(std::string("no pipe: ") + std::strerror(errno));
    process_ = fork();
    if (process_ == 0) {
      dup2(ends[0], STDIN_FILENO);
      close(ends[0]), close(ends[1]);
      execvp(words.front(), words.data());
      _exit(kNotFound);
    }
    close(ends[0]);
    if (process_ < 0) throw Error::Job(std::string("no process: ") + std::strerror(errno));
    to_ = fdopen(ends[1], "wb");
  }
  ~ProgramFilm() override {
    if (process_ > 0) End();
  }

  void Add(const Image& image) override {
    if (std::fwrite(image.rgb.data(), 1, image.rgb.size(), to_) != image.rgb.size()) Fail();
    ++frames_;
  }

  void Finish() override {
    if (frames_ == 0) throw Error::Job("a film needs at least one frame");
    const int status = End();
    if (status != 0) Refuse(status);
  }

 private:
  static constexpr int kNotFound = 127;

  int End() {
    std::fclose(to_);
    int status = 0;
    waitpid(process_, &status, 0);
    process_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

  [[noreturn]] void Fail() { Refuse(End()); }

  [[noreturn]] void Refuse(int status) const {
    if (status == kNotFound) {
      throw Error::Job("films need the program ffmpeg, and there is no '" + name_ +
                       "': pip install imageio-ffmpeg, or install ffmpeg");
    }
    throw Error::Job(name_ + " could not write the film (exit code " + std::to_string(status) +
                     ")");
  }

  std::string name_;
  pid_t process_ = -1;
  std::FILE* to_ = nullptr;
  long frames_ = 0;
};

}  // namespace

std::unique_ptr<FilmFile> NewProgramFilm(const fs::path& file, int width, int height, int fps) {
  return std::make_unique<ProgramFilm>(CommandFor(file, width, height, fps));
}

}  // namespace continuum
