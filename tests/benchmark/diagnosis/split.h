#pragma once

#include <chrono>
#include <ctime>
#include <string>
#include <vector>

namespace continuum::speed {

/// Where the time of a diagnosis goes, by what it says of its progress. All that a search for a
/// second cause takes is one part.
class Split {
 public:
  struct Part {
    const char* said;  ///< how what is said begins
    const char* name;
    double wall = 0, processor = 0;  ///< s
  };

  /// What follows belongs to what is said now.
  void Next(const std::string& said) {
    Stop();
    Part* const part = PartOf(said);
    const bool inner = now_ && now_->name == kSecond && part >= &parts_[1] && part <= &parts_[4];
    if (part && !inner) now_ = part;
  }
  void Stop() {
    const auto wall = std::chrono::steady_clock::now();
    const std::clock_t processor = std::clock();
    if (now_) {
      now_->wall += std::chrono::duration<double>(wall - wall_).count();
      now_->processor += static_cast<double>(processor - processor_) / CLOCKS_PER_SEC;
    }
    wall_ = wall, processor_ = processor;
  }
  const std::vector<Part>& parts() const { return parts_; }

 private:
  Part* PartOf(const std::string& said) {
    for (Part& part : parts_) {
      if (said.starts_with(part.said)) return &part;
    }
    return nullptr;
  }

  static constexpr const char* kSecond = "second cause";
  std::vector<Part> parts_{{"null fit", "null fit"},
                           {"screen", "sensitivities of all candidates"},
                           {"significance", "bootstrap of p-values"},
                           {"fit", "refits"},
                           {"sensitivities", "sensitivities of the best"},
                           {"what is left", "lack of fit"},
                           {"a second cause", kSecond},
                           {"at a fine step", "fit at a fine step"},
                           {"folds", "folds"},
                           {"ceiling", "ceiling"},
                           {"random force", "placebos"},
                           {"gain", "bootstrap of the gain"},
                           {"a force without", "force without a cause"},
                           {"next experiment", "next experiment"}};
  Part* now_ = nullptr;
  std::chrono::steady_clock::time_point wall_;
  std::clock_t processor_ = 0;
};

}  // namespace continuum::speed
