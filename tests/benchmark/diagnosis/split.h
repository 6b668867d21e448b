#pragma once

#include <chrono>
#include <ctime>
#include <string>
#include <vector>

namespace continuum::speed {

/// Where the time of a diagnosis goes, by what it says of its progress.
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
    if (Part* const part = PartOf(said)) now_ = part;
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

  std::vector<Part> parts_{{"null fit", "null fit"},
                           {"screen: significance", "bootstrap of p-values"},
                           {"screen", "sensitivities of all candidates"},
                           {"fits: sensitivities", "sensitivities of the best"},
                           {"fits: lack of fit", "lack of fit"},
                           {"fits: at a fine step", "fit at a fine step"},
                           {"fits", "refits"},
                           {"other candidates", "other places, other effects"},
                           {"second cause", "second cause"},
                           {"judgement: missing force", "missing force"},
                           {"judgement: at a fine step", "fit at a fine step"},
                           {"judgement: folds", "folds"},
                           {"judgement: ceiling", "ceiling"},
                           {"judgement: random forces", "placebos"},
                           {"judgement", "sensitivities of the named"},
                           {"gain", "bootstrap of the gain"},
                           {"force without a cause", "force without a cause"},
                           {"next experiment", "next experiment"}};
  Part* now_ = nullptr;
  std::chrono::steady_clock::time_point wall_;
  std::clock_t processor_ = 0;
};

}  // namespace continuum::speed
