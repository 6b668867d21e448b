#pragma once

#include <cstddef>
#include <functional>
#include <set>
#include <string>

namespace continuum {

/// How far long work has come, for whoever waits for it.
struct Progress {
  std::string stage;                 ///< kind of work that is going on, "screen"
  std::size_t done = 0, of = 0;      ///< steps of the stage; of = 0: nobody knows how many
  std::string at = {};               ///< what is worked on now, "payload at body tip"
  std::size_t number = 0, last = 0;  ///< of the stage among all; 0: nobody knows
};

using ProgressCallback = std::function<void(const Progress&)>;

/// Work that is a part of a longer stage: its reports stand for `outer`, and say in `at` what they
/// are about. An empty callback stays empty.
ProgressCallback Within(const Progress& outer, const ProgressCallback& callback);

/// Progress as text. It remembers when steps were done, to say how long the others will take.
class ProgressText {
 public:
  /// "2/10 screen, 31 of 74, about 12 s more: payload at body tip", at most width characters.
  /// now [s]: of any clock.
  std::string Line(const Progress& progress, double now, std::size_t width);
  /// The first time that a stage is reported what begins, "screen (74 steps)"; else nothing.
  std::string Beginning(const Progress& progress);

 private:
  void Follow(const Progress& progress, double now);
  std::string TimeLeft(const Progress& progress, double now) const;

  Progress first_;  // of the steps that are timed
  double began_ = 0;
  std::set<std::string> begun_;  // stages
};

}  // namespace continuum
