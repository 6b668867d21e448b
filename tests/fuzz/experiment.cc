// An EXPERIMENT.yaml beside a good model and a log that has a column for each of its outputs.
#include "sim/experiment/experiment.h"
#include "app/bench.h"
#include "fuzz/fuzz.h"

namespace continuum {
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const auto model = fuzz::Write("model.xml", testing::kModel);
  static const auto log = fuzz::Write("log.csv",
                                      "t,u,q,f,y,qw,qx,qy,qz\n0,0.1,0,0,1,1,0,0,0\n"
                                      "0.1,0.1,0.01,0,1,1,0,0,0\n0.2,0.1,0.03,0,1,1,0,0,0\n"
                                      "0.3,0.1,0.06,0,1,1,0,0,0\n");
  const auto file = fuzz::Write("experiment.yaml", fuzz::Text(data, size));
  return fuzz::Refused([&] { Experiment::Read(file); });
}

}  // namespace continuum
