#include "identification/diagnosis/result.h"

#include <array>

#include "sim/io/interrupt.h"

namespace continuum {
namespace {

constexpr std::array kStages{"null fit",        "screen",    "fits", "other candidates",
                             "second cause",    "judgement", "gain", "force without a cause",
                             "next experiment", "files"};

}  // namespace

Progress ProgressOf(DiagnosisStage stage, const std::string& at, std::size_t done, std::size_t of) {
  const auto number = static_cast<std::size_t>(stage);
  return {kStages.at(number), done, of, at, number + 1, kStages.size()};
}

void DiagnosisOptions::Say(DiagnosisStage stage, const std::string& at, std::size_t done,
                           std::size_t of) const {
  StopIfRequested();
  if (progress) progress(ProgressOf(stage, at, done, of));
}

DiagnosisOptions DiagnosisOptions::Inside(DiagnosisStage stage, const std::string& at,
                                          std::size_t done, std::size_t of) const {
  DiagnosisOptions inside = *this;
  inside.progress = Within(ProgressOf(stage, at, done, of), progress);
  return inside;
}

}  // namespace continuum
