#include "models/statics/foreign_options.h"

#include "error.h"

namespace continuum::statics {

void RefuseGiven(const std::string& robot, const ForeignOptions& options) {
  for (const auto& [option, given] : options) {
    if (given) throw Error::Input(option, "no such option for a robot " + robot);
  }
}

void RefuseForeignOptions(const SolveRequest& request, const std::string& robot,
                          const ForeignOptions& foreign) {
  RefuseGiven(robot, foreign);
  RefuseGiven(robot,
              {{"--reach with --equilibria", request.equilibria && !request.reach.empty()},
               {"--measured with --equilibria", request.equilibria && !request.measured.empty()}});
  if (request.calibrate) {
    RefuseGiven(robot, {{"--equilibria with --calibrate", request.equilibria},
                        {"--shape with --calibrate", !request.shape.empty()},
                        {"--compliance with --calibrate", !request.compliance.empty()},
                        {"--outlines with --calibrate", !request.outlines.empty()},
                        {"--plot with --calibrate", !request.plot.empty()},
                        {"--reach with --calibrate", !request.reach.empty()},
                        {"--follow with --calibrate", !request.follow.empty()},
                        {"--errors with --calibrate", !request.errors.empty()},
                        {"--boxplot with --calibrate", !request.boxplot.empty()}});
  }
  if (request.input.empty()) throw Error::Input("--input", "a CSV file", "nothing");
}

}  // namespace continuum::statics
