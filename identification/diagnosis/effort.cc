#include "identification/diagnosis/effort.h"

#include <algorithm>
#include <array>
#include <limits>
#include <string>

#include "error.h"
#include "sim/numerics/parallel.h"

namespace continuum {
namespace {

constexpr std::size_t kStages = 7;  // with a time of their own

// The processor time of an effort [s], and of it what is over at the end of each stage.
struct Shares {
  double seconds;
  std::array<double, kStages> end;
};

// Two processors, which share the work by three quarters, take less than 10 s and 60 s, with
// reports and the last fit of a stage on top. Where there is little, most is for a look at all
// candidates: what was not seen cannot be named.
//   null fit, screen, fits, other candidates, second cause, judgement, gain and all behind it
constexpr Shares kQuick{14, {0.2, 0.66, 0.82, 0.84, 0.88, 0.97, 1}},
    kNormal{75, {0.2, 0.4, 0.58, 0.65, 0.85, 0.97, 1}},
    kThorough{std::numeric_limits<double>::infinity(), kNormal.end};

const Shares& SharesOf(Effort effort) {
  switch (effort) {
    case Effort::kQuick:
      return kQuick;
    case Effort::kNormal:
      return kNormal;
    case Effort::kThorough:
      break;
  }
  return kThorough;
}

}  // namespace

Effort EffortNamed(std::string_view name) {
  if (name == "quick") return Effort::kQuick;
  if (name == "normal") return Effort::kNormal;
  if (name == "thorough") return Effort::kThorough;
  throw Error::Input("effort", "quick, normal or thorough", "'" + std::string(name) + "'");
}

TimeBudget::TimeBudget(Effort effort, double share)
    : begin_(std::chrono::steady_clock::now()),
      begin_processor_(ProcessorSeconds()),
      effort_(effort),
      seconds_(share * SharesOf(effort).seconds) {}

double TimeBudget::Begin(DiagnosisStage stage) {
  const Shares& shares = SharesOf(effort_);
  const double end = shares.end[std::min(static_cast<std::size_t>(stage), kStages - 1)];
  if (end == share_) return end_;
  const double left = begin_processor_ + seconds_ - ProcessorSeconds();
  const double own = (end - share_) / (1 - share_) * std::max(0.0, left);
  share_ = end;
  return end_ = std::max(begin_processor_ + end * seconds_, ProcessorSeconds() + own);
}

double TimeBudget::BeginPart(DiagnosisStage stage, double share) {
  return std::min(Begin(stage), ProcessorSeconds() + share * seconds_);
}

double TimeBudget::seconds() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
}

}  // namespace continuum
