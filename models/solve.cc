#include "models/solve.h"

#include "error.h"
#include "models/stiff_flop/solve.h"
#include "models/tdcr/solve.h"
#include "models/twin_pivot/solve.h"
#include "sim/io/yaml.h"

namespace continuum {

int Solve(const SolveRequest& request) {
  const Yaml robot = Yaml::Read(request.robot);
  const Yaml name =
      robot.Has("robot") || !robot.Has("model") ? robot.At("robot") : robot.At("model");
  const std::string kind = name.Text();
  if (kind == "tdcr") return SolveTdcr(request);
  if (kind == "twin_pivot") return SolveTwinPivot(request);
  if (kind == "stiff_flop") return SolveStiffFlop(request);
  throw Error::Input(name.Where(), "tdcr, twin_pivot or stiff_flop", "'" + kind + "'");
}

}  // namespace continuum
