// An EXPERIMENT.yaml beside a good model and log.
#include "sim/experiment.h"
#include "app/bench.h"
#include "fuzz/fuzz.h"

namespace continuum {
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const auto model = fuzz::Write("model.xml", testing::kModel);
  static const auto log = fuzz::Write("log.csv", testing::kLog);
  const auto file = fuzz::Write("experiment.yaml", fuzz::Text(data, size));
  return fuzz::Refused([&] { Experiment::Read(file); });
}

}  // namespace continuum
