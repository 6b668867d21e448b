#include "random_diagnoses/random_case.h"

#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "binding/effect_catalog.h"
#include "random_diagnoses/draw.h"
#include "random_diagnoses/random_model.h"
#include "sim/io/file.h"
#include "sim/model/model_spec.h"

namespace continuum::random_diagnoses {
namespace {

// A text of YAML, whatever characters it has.
std::string Quoted(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("''") : std::string(1, c);
  return quoted + "'";
}

class Case {
 public:
  Case(std::uint64_t seed, const std::filesystem::path& folder)
      : draw_(seed), folder_(folder), model_(DrawModel(draw_)) {}

  std::filesystem::path Write() {
    WriteFile(folder_ / "model.xml", model_.xml);
    WriteFile(folder_ / "truth.xml", model_.truth);
    ChooseColumns();
    const std::string logs = Logs();
    std::string y = "format: 1\nmodel: model.xml\ntime: {column: t, unit: s}\nstart: " +
                    draw_.Of({"rest", "rest", "equilibrium", "measured", "estimate"}) + "\n";
    y += "inputs:\n" + inputs_ + "outputs:\n" + outputs_ + Parameters() + Candidates();
    if (draw_.Chance(0.1)) y += "loss: {soft_l1: 3}\n";
    if (draw_.Chance(trials_ > 1 ? 0.1 : 0.8)) y += "folds: [window]\n";
    WriteFile(folder_ / "experiment.yaml", y + "logs:\n" + logs);
    return folder_ / "experiment.yaml";
  }

 private:
  void ChooseColumns() {
    for (const std::string& actuator : model_.actuators) {
      if (actuator.empty() || draw_.Chance(0.1)) continue;
      driven_.push_back(actuator);
      inputs_ +=
          fmt::format("  - {{column: {}, unit: '1', actuator: {}{}}}\n", Quoted("u " + actuator),
                      Quoted(actuator), draw_.Chance(0.2) ? ", interpolate: linear" : "");
    }
    if (inputs_.empty()) inputs_ = "  []\n";
    const int outputs = draw_.Whole(1, 4);
    for (int i = 0; i < outputs; ++i) {
      const Seen& seen = draw_.From(model_.seen);
      const auto same = [&](const Seen& other) { return other.source == seen.source; };
      if (std::any_of(measured_.begin(), measured_.end(), same)) continue;
      measured_.push_back(seen);
      outputs_ += fmt::format("  - {{column: {}, unit: {}, sensor: {}{}{}}}\n",
                              Quoted("y " + seen.source), Quoted(seen.unit), Quoted(seen.source),
                              draw_.Chance(0.2) ? ", sigma: 0.001" : "",
                              draw_.Chance(0.1) ? ", scale: -1.1" : "");
    }
  }

  std::string Logs() {
    trials_ = draw_.Chance(0.2) ? 1 : draw_.Whole(2, 3);
    const int copies = draw_.Whole(1, 2);
    const bool conditions = draw_.Chance(0.2), other_clocks = draw_.Chance(0.2);
    rows_ = draw_.Chance(0.15) ? draw_.Whole(1, 8) : draw_.Whole(20, 60);
    std::string text;
    for (int trial = 0; trial < trials_; ++trial) {
      const std::uint64_t motion = draw_.Index(1u << 30);
      for (int copy = 0; copy < copies; ++copy) {
        const std::string name = fmt::format("t{}_{}.csv", trial, copy);
        const double clock = other_clocks && copy ? draw_.Within(-0.004, 0.004) : 0;
        WriteFile(folder_ / name, Csv(motion, clock));
        const bool validate = trials_ > 1 && trial == trials_ - 1;
        text += fmt::format("  - {{file: {}, trial: t{}, use: {}{}}}\n", name, trial,
                            validate ? "validate" : "train",
                            conditions ? fmt::format(", condition: c{}", trial % 2) : "");
      }
    }
    return text;
  }

  double Control(Draw& motion, std::vector<double>& wave, double t) const {
    if (wave.empty()) {
      wave = {motion.Within(0.1, 0.8), motion.Within(2, 20), motion.Within(0, 0.3)};
      if (motion.Chance(0.2)) wave[0] = 0;  // it rests
    }
    return wave[2] + wave[0] * std::sin(wave[1] * t);
  }

  // What the true model does, from its reference pose at rest.
  std::string Csv(std::uint64_t motion, double clock) {
    const ModelAndData truth = ModelSpec::Parse(model_.truth, folder_).Build();
    const mjModel& m = *truth.model;
    mjData& d = *truth.data;
    Draw same(motion);
    std::vector<std::vector<double>> waves(driven_.size());
    const double noise = draw_.Chance(0.1) ? 0 : 1e-3;
    const std::size_t stuck = draw_.Chance(0.1) ? draw_.Index(measured_.size()) : measured_.size();
    std::string text = "t";
    for (const std::string& actuator : driven_) text += ",\"u " + actuator + "\"";
    for (const Seen& seen : measured_) text += ",\"y " + seen.source + "\"";
    for (int row = 0; row < rows_; ++row) {
      const double t = kPeriod * row;
      text += fmt::format("\n{:.6f}", t + (row ? clock : 0));
      for (std::size_t i = 0; i < driven_.size(); ++i) {
        const double u = Control(same, waves[i], t);
        const int a = mj_name2id(&m, mjOBJ_ACTUATOR, driven_[i].c_str());
        if (m.actuator_ctrlnum[a] > 0) d.ctrl[m.actuator_ctrladr[a]] = u;
        text += fmt::format(",{:.9g}", u);
      }
      mj_forward(&m, &d);
      for (std::size_t i = 0; i < measured_.size(); ++i) text += Cell(m, d, i, i == stuck, noise);
      for (long k = std::lround(kPeriod / m.opt.timestep); k > 0; --k) mj_step(&m, &d);
    }
    return text + "\n";
  }

  std::string Cell(const mjModel& m, const mjData& d, std::size_t i, bool stuck, double noise) {
    if (draw_.Chance(gaps_)) return draw_.Of({",", ",nan"});
    if (stuck) return ",0.25";
    std::string name = measured_[i].source;
    int id = mj_name2id(&m, mjOBJ_SENSOR, name.c_str()), component = 0;
    if (id < 0) {
      component = name[name.size() - 2] - '0';
      id = mj_name2id(&m, mjOBJ_SENSOR, name.substr(0, name.size() - 3).c_str());
    }
    const double value = d.sensordata[m.sensor_adr[id] + component];
    return fmt::format(",{:.9g}", value + noise * draw_.Normal());
  }

  std::string Parameters() {
    std::string text;
    for (std::size_t i = 0; i < model_.joints.size(); ++i) {
      if (model_.joints[i].empty() || !draw_.Chance(0.08)) continue;
      std::string name;
      for (const char c : model_.joints[i])
        name += std::string(" *[]?\\").find(c) != std::string::npos ? std::string("\\") + c
                                                                    : std::string(1, c);
      text += fmt::format(
          "  - {{name: b{}, target: {}, attribute: damping, initial: 0.1, lower: 0, upper: 10}}\n",
          i, Quoted("joint:" + name));
    }
    return text.empty() ? "" : "parameters:\n" + text;
  }

  std::string Candidates() {
    if (draw_.Chance(0.1)) return "candidates: all\n";
    std::string text = "candidates:\n";
    const int count = draw_.Whole(1, 4);
    std::vector<std::string> taken;
    for (int i = 0; i < count; ++i) {
      const std::string effect(draw_.From(Catalog()).name);
      if (std::find(taken.begin(), taken.end(), effect) != taken.end()) continue;
      taken.push_back(effect);
      text += "  - " + effect + "\n";
    }
    if (draw_.Chance(0.15))
      text +=
          "  - {effect: formula_friction, name: mine, level: 'a*(1 + b*load)', parameters: "
          "[{name: a, unit: N*m, initial: 0.02, lower: 0, upper: 1, absent: 0}, {name: b, "
          "unit: '1', initial: 0.1, lower: 0, upper: 1}]}\n";
    return text;
  }

  static constexpr double kPeriod = 0.01;  // s

  Draw draw_;
  std::filesystem::path folder_;
  RandomModel model_;
  std::vector<std::string> driven_;
  std::vector<Seen> measured_;
  std::string inputs_, outputs_;
  int rows_ = 0, trials_ = 1;
  double gaps_ = draw_.Chance(0.2) ? draw_.Within(0.01, 0.5) : 0;
};

}  // namespace

std::filesystem::path WriteRandomCase(std::uint64_t seed, const std::filesystem::path& folder) {
  return Case(seed, folder).Write();
}

}  // namespace continuum::random_diagnoses
