#include "models/spa/recipe.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace continuum {
namespace {

using Eigen::Vector3d;

// Line pressures [Pa] of the valves that are open. Hanging, all three chambers together stay at
// 40 kPa or below: the softening elongation spring has no equilibrium much above.
std::vector<Vector3d> IdentificationSteps() {
  std::vector<Vector3d> steps;
  for (const double p : {20e3, 40e3, 60e3, 75e3}) {
    for (int i = 0; i < 3; ++i) steps.push_back(p * Vector3d::Unit(i));
  }
  for (const double p : {15e3, 25e3, 35e3, 45e3}) {
    for (int i = 0; i < 3; ++i) steps.push_back(p * (Vector3d::Ones() - Vector3d::Unit(i)));
  }
  for (const double p : {15e3, 20e3, 25e3, 30e3, 35e3, 40e3}) steps.push_back(p * Vector3d::Ones());
  return steps;
}

std::vector<Vector3d> ValidationSteps() {
  return {{50e3, 0, 0},    {0, 70e3, 0},    {0, 0, 30e3},
          {40e3, 40e3, 0}, {0, 30e3, 30e3}, {32e3, 32e3, 32e3}};
}

std::vector<SpaRecordedTrial> Record(const Spa<double>& spa, const std::vector<Vector3d>& steps,
                                     const SpaRecipe& recipe, unsigned first_seed) {
  std::vector<SpaRecordedTrial> trials;
  for (const Vector3d& step : steps) {
    const SpaRecording recording =
        SpaRecordStep(spa, step, recipe.noise, first_seed + unsigned(trials.size()));
    trials.push_back({recording, SpaRegain(spa.parameters().Segment(), recording, recipe.filter)});
  }
  return trials;
}

// Collects the squared errors of one channel, step by step.
class Channel {
 public:
  Channel(std::string name, std::string unit, double scale)
      : name_(std::move(name)), unit_(std::move(unit)), scale_(scale) {}

  void Add(double measured, double modelled) {
    const double error = scale_ * (measured - modelled);
    sum_ += error * error;
    ++count_;
    largest_ = std::max(largest_, std::abs(scale_ * measured));
  }
  void EndStep() {
    const double mean = sum_ / double(count_);
    best_ = std::min(best_, mean);
    worst_ = std::max(worst_, mean);
    total_ += sum_;
    total_count_ += count_;
    sum_ = 0;
    count_ = 0;
  }
  SpaError Error() const {
    return {name_, unit_,  total_ / double(total_count_),
            best_, worst_, std::sqrt(best_) / largest_};
  }

 private:
  std::string name_, unit_;
  double scale_, sum_ = 0, total_ = 0, largest_ = 0, worst_ = 0;
  double best_ = std::numeric_limits<double>::infinity();
  std::size_t count_ = 0, total_count_ = 0;
};

std::vector<SpaError> Errors(const std::vector<Channel>& channels) {
  std::vector<SpaError> errors;
  for (const Channel& channel : channels) errors.push_back(channel.Error());
  return errors;
}

// The nine rows of (16): the base wrench against the sensor, the forces on δ against the actuation
// by the measured pressures.
std::vector<SpaError> InverseErrors(const Spa<double>& model,
                                    const std::vector<SpaRecordedTrial>& trials,
                                    const SpaFilter& filter) {
  std::vector<Channel> channels;
  for (const char* name : {"f_x", "f_y", "f_z"}) channels.emplace_back(name, "N²", 1);
  for (const char* name : {"m_x", "m_y", "m_z"}) channels.emplace_back(name, "(N mm)²", 1e3);
  for (const char* name : {"τ_Δx", "τ_Δy", "τ_δL"}) channels.emplace_back(name, "N²", 1);
  const SpaBase<double> base = SpaBase<double>::Hanging();
  for (const auto& [recording, motion] : trials) {
    const auto pressure = SpaChamberPressure(recording, model.parameters().T_PT1, filter);
    for (std::size_t k = 0; k < motion.state.size(); ++k) {
      const auto left = model.InverseDynamics(motion.state[k], motion.acceleration[k], base);
      const Vector3d actuation = model.Actuation(motion.state[k].delta, pressure[k]);
      for (int i = 0; i < 6; ++i) channels[i].Add(motion.wrench[k][i], left[i]);
      for (int i = 0; i < 3; ++i) channels[6 + i].Add(actuation[i], left[6 + i]);
    }
    for (Channel& channel : channels) channel.EndStep();
  }
  return Errors(channels);
}

std::vector<SpaSample> Simulate(const Spa<double>& model, const std::vector<Vector3d>& pressure,
                                double period) {
  const SpaBase<double> base = SpaBase<double>::Hanging();
  return SpaRespond(model, SpaAtRest(model, pressure[0], base), pressure, period,
                    [&](double) { return base; });
}

// Hybrid dynamics driven by the measured line pressures against the regained motion.
std::vector<SpaError> SimulationErrors(const Spa<double>& model,
                                       const std::vector<SpaRecordedTrial>& trials) {
  std::vector<Channel> channels;
  for (const char* name : {"Δx", "Δy", "δL"}) channels.emplace_back(name, "mm²", 1e3);
  for (const auto& [recording, motion] : trials) {
    const auto samples = Simulate(model, recording.pressure, recording.period);
    for (std::size_t k = 0; k < motion.state.size(); ++k) {
      for (int i = 0; i < 3; ++i) {
        channels[i].Add(motion.state[k].delta[i], samples[k + kSpaTrim].delta[i]);
      }
    }
    for (Channel& channel : channels) channel.EndStep();
  }
  return Errors(channels);
}

SpaDifference Difference(const std::string& what, const Spa<double>& a, const Spa<double>& b) {
  Vector3d square = Vector3d::Zero(), low = Vector3d::Zero(), high = Vector3d::Zero();
  std::size_t count = 0;
  for (const Vector3d& step : ValidationSteps()) {
    std::vector<Vector3d> pressure(1201, step);
    std::fill_n(pressure.begin(), 200, Vector3d::Zero());
    const auto first = Simulate(a, pressure, 1e-3), second = Simulate(b, pressure, 1e-3);
    for (std::size_t k = 0; k < first.size(); ++k) {
      square += (first[k].delta - second[k].delta).cwiseAbs2();
      low = low.cwiseMin(first[k].delta);
      high = high.cwiseMax(first[k].delta);
    }
    count += first.size();
  }
  return {what, (square / double(count)).cwiseSqrt().cwiseQuotient(high - low)};
}

std::vector<SpaDifference> Differences(const SpaFile& truth) {
  const auto model = [&](SpaMass mass, SpaActuation actuation) {
    return Spa<double>(truth.parameters, {mass, actuation, truth.options.gravity});
  };
  const auto paper = model(SpaMass::kCentroid, SpaActuation::kTip);
  return {{Difference("mass: centroid → arc", paper, model(SpaMass::kArc, SpaActuation::kTip))},
          {Difference("actuation: tip → volume", paper,
                      model(SpaMass::kCentroid, SpaActuation::kVolume))}};
}

std::string Row(const SpaError& e) {
  return fmt::format("| {} / {} | {:.5f} | {:.5f} | {:.5f} | {:.2f} % |\n", e.channel, e.unit,
                     e.all, e.best, e.worst, 100 * e.best_share);
}

std::string ErrorTable(const std::string& title, const std::vector<SpaError>& errors) {
  std::string text = fmt::format(
      "\n{}\n\n| Channel | MSE | best step | worst step | best RMS / largest |\n"
      "|---|---|---|---|---|\n",
      title);
  for (const SpaError& e : errors) text += Row(e);
  return text;
}

std::string ParameterTable(const SpaParameters<double>& truth, const SpaParameters<double>& found) {
  struct Line {
    const char *name, *unit;
    double scale, truth, found;
  };
  const Line lines[] = {{"x_m", "mm", 1e3, truth.x_m, found.x_m},
                        {"y_m", "mm", 1e3, truth.y_m, found.y_m},
                        {"T_PT1", "ms", 1e3, truth.T_PT1, found.T_PT1},
                        {"A", "mm²", 1e6, truth.A, found.A},
                        {"m", "kg", 1, truth.m, found.m},
                        {"d_theta", "kg/s", 1, truth.d_theta, found.d_theta},
                        {"d_dL", "kg/s", 1, truth.d_dL, found.d_dL},
                        {"k_theta", "N/m", 1, truth.k_theta, found.k_theta},
                        {"k_dL1", "N/m", 1, truth.k_dL1, found.k_dL1},
                        {"k_dL3", "N/m³", 1, truth.k_dL3, found.k_dL3}};
  std::string text =
      "Table I: identified parameters\n\n| Parameter | true | identified | off by |\n"
      "|---|---|---|---|\n";
  for (const Line& l : lines) {
    text += fmt::format("| {} / {} | {:.6g} | {:.5g} | {:+.2f} % |\n", l.name, l.unit,
                        l.scale * l.truth, l.scale * l.found, 100 * (l.found / l.truth - 1));
  }
  return text;
}

}  // namespace

SpaRecipeResult RunSpaRecipe(const SpaFile& truth, const SpaRecipe& recipe) {
  const Spa<double> spa(truth.parameters, truth.options);
  const auto train = Record(spa, IdentificationSteps(), recipe, 1000 * recipe.seed);
  const auto validate = Record(spa, ValidationSteps(), recipe, 1000 * recipe.seed + 500);

  SpaSwarm swarm;
  swarm.seed = recipe.seed;
  swarm.progress = recipe.progress;
  SpaRecipeResult result;
  result.truth = truth.parameters;
  result.found = SpaIdentify(truth.parameters, truth.options, train, recipe.filter, swarm);

  const Spa<double> model(result.found, truth.options);
  const auto on_train = InverseErrors(model, train, recipe.filter);
  // As in the paper, only what the identification used is shown on its data.
  for (const std::size_t i : {2, 6, 7, 8}) result.identification.push_back(on_train[i]);
  result.validation = InverseErrors(model, validate, recipe.filter);
  result.simulation = SimulationErrors(model, validate);
  result.differences = Differences(truth);
  return result;
}

std::string SpaTables(const SpaRecipeResult& result) {
  std::string text = ParameterTable(result.truth, result.found);
  text += ErrorTable("Table II: inverse dynamics, identification data", result.identification);
  text += ErrorTable("Table II: inverse dynamics, validation data", result.validation);
  text += ErrorTable("Hybrid simulation, validation data", result.simulation);
  text +=
      "\nChoices of the model, RMS difference on the validation steps over the range\n\n"
      "| Choice | Δx | Δy | δL |\n|---|---|---|---|\n";
  for (const auto& [what, share] : result.differences) {
    text += fmt::format("| {} | {:.1f} % | {:.1f} % | {:.1f} % |\n", what, 100 * share[0],
                        100 * share[1], 100 * share[2]);
  }
  return text;
}

}  // namespace continuum
