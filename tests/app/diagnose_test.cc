// What `diagnose` says beside its answer.
#include "bench.h"

namespace continuum::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class Diagnosing : public AppBench {
 protected:
  std::string Says() const { return Run({"diagnose", "experiment.yaml", "--out", "out"}).err; }
};

TEST_F(Diagnosing, ALossOfTheExperimentIsSaidNotToBeUsed) {
  const std::string said = "warning: experiment.yaml: `loss: soft_l1` is for identify";
  EXPECT_THAT(Says(), Not(HasSubstr(said)));
  Spoil("experiment.yaml", "format: 1\n", "format: 1\nloss: {soft_l1: 2}\n");
  EXPECT_THAT(Says(), HasSubstr(said));
}

}  // namespace
}  // namespace continuum::testing
