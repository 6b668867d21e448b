#include "app/console.h"

#include <unistd.h>

#include <cstdio>

namespace continuum {
namespace {
bool open_line = false;
}

void ShowProgress(const std::string& text) {
  if (isatty(STDERR_FILENO)) {
    std::fprintf(stderr, "\r\033[K%s", text.c_str());
    open_line = true;
  } else {
    std::fprintf(stderr, "%s\n", text.c_str());
  }
  std::fflush(stderr);
}

void EndProgress() {
  if (open_line) std::fprintf(stderr, "\n");
  open_line = false;
}

}  // namespace continuum
