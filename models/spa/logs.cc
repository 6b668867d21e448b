#include "models/spa/logs.h"

#include <string>
#include <vector>

#include <fmt/format.h>

#include "models/spa/chain.h"
#include "sim/io/file.h"

namespace continuum {
namespace {

using Eigen::Vector3d;

struct Step {
  const char* name;
  Vector3d pressure;  // [Pa]
};

// Of the paper's thirty, those that move most without the elongation's fold.
std::vector<Step> Steps() {
  return {{"one", {60e3, 0, 0}},     {"two", {0, 60e3, 0}},           {"three", {0, 0, 60e3}},
          {"pair", {35e3, 35e3, 0}}, {"other_pair", {0, 35e3, 35e3}}, {"all", {35e3, 35e3, 35e3}}};
}

// A chamber's base hangs: its y and z point against the world's.
std::string Csv(const SpaRecording& recording, const Vector3d& pressure) {
  constexpr std::size_t kEvery = 5;
  std::string csv = "time,p1,p2,p3,x,y,z,fx,fy,fz,mx,my,mz\n";
  for (std::size_t k = 0; k < recording.tip.size(); k += kEvery) {
    const double time = recording.period * static_cast<double>(k);
    const Vector3d p = time < 0.2 - 1e-9 ? Vector3d::Zero().eval() : pressure;
    const Vector3d& tip = recording.tip[k];
    csv += fmt::format("{:.3f},{},{},{},{:.9g},{:.9g},{:.9g}", time, p[0], p[1], p[2], tip[0],
                       -tip[1], -tip[2]);
    for (int i = 0; i < 6; ++i) csv += fmt::format(",{:.9g}", recording.wrench[k][i]);
    csv += "\n";
  }
  return csv;
}

std::string Parameter(const std::string& name, const std::string& target, double truth,
                      double start, const std::string& more = "") {
  const double low = 0.3 * truth, high = 3 * truth;
  return fmt::format(
      "  - {{name: {}, target: \"{}\", attribute: {}, initial: {:.6g}, lower: {:.6g}, upper: "
      "{:.6g}}}\n",
      name, target, more.empty() ? name : more, start * truth, std::min(low, high),
      std::max(low, high));
}

std::string ExperimentText(const SpaParameters<double>& p, const SpaNoise& noise) {
  std::string text = "format: 1\nmodel: spa.xml\nstart: equilibrium\ninputs:\n";
  for (int i = 1; i <= 3; ++i)
    text += fmt::format("  - {{column: p{0}, unit: Pa, actuator: p{0}}}\n", i);
  text += "outputs:\n";
  const struct {
    const char *columns, *unit, *sensor;
    double sigma;
  } outputs[] = {{"xyz", "m", "tip_pos", noise.tip},
                 {"f", "N", "base_force", noise.force},
                 {"m", "N*m", "base_torque", noise.torque}};
  for (const auto& out : outputs) {
    for (int i = 0; i < 3; ++i) {
      const std::string axis(1, "xyz"[i]);
      const std::string column = out.columns[1] ? axis : out.columns + axis;
      text += fmt::format("  - {{column: {}, unit: {}, sensor: \"{}[{}]\", sigma: {}}}\n", column,
                          out.unit, out.sensor, i, out.sigma);
    }
  }
  text += "parameters:\n";
  const std::string law = "plugin:segment";
  text += Parameter("x_m", law, p.x_m, 0.5) + Parameter("y_m", law, p.y_m, 1.4) +
          Parameter("T_PT1", "actuator:p*", p.T_PT1, 1.5, "\"dynprm[0]\"") +
          Parameter("A", law, p.A, 0.8);
  text +=
      "  - {name: m, target: \"body:link*\", attribute: mass, operation: scale, initial: 1.3, "
      "lower: 0.3, upper: 3}\n";
  return text + Parameter("d_theta", law, p.d_theta, 1.5) + Parameter("d_dL", law, p.d_dL, 0.6) +
         Parameter("k_theta", law, p.k_theta, 1.3) + Parameter("k_dL1", law, p.k_dL1, 1.2) +
         Parameter("k_dL3", law, p.k_dL3, 0.7);
}

}  // namespace

void WriteSpaLogs(const SpaFile& truth, const SpaNoise& noise, unsigned seed,
                  const std::filesystem::path& folder) {
  SpaOptions options = truth.options;
  options.mass = SpaMass::kArc;
  const Spa<double> spa(truth.parameters, options);
  MakeFolder(folder);
  WriteFile(folder / "spa.xml", SpaMjcf(truth, {}));
  std::string text = ExperimentText(truth.parameters, noise) + "logs:\n";
  for (const Step& step : Steps()) {
    const SpaRecording recording = SpaRecordStep(spa, step.pressure, noise, seed++);
    WriteFile(folder / (std::string(step.name) + ".csv"), Csv(recording, step.pressure));
    text += fmt::format("  - {{file: {}.csv}}\n", step.name);
  }
  WriteFile(folder / "experiment.yaml", text);
}

}  // namespace continuum
