#include "identification/diagnosis/next_experiment.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include "error.h"
#include "identification/diagnosis/search_rules.h"
#include "sim/io/csv.h"
#include "sim/io/decimal.h"
#include "sim/io/units.h"

namespace continuum {
namespace {

using Signal = std::vector<double>;

constexpr double kWeights[] = {0.1, 0.5};  // known ones to add, of the mean mass of a body
constexpr double kTau = 2 * std::numbers::pi;

// A change of all inputs of a log. u: one input over its rows.
struct Variation {
  std::string words;
  std::function<Signal(const Signal& u)> change;
};

double TwoDigits(double value) {
  const double unit = std::pow(10, std::floor(std::log10(value)) - 1);
  return std::round(value / unit) * unit;
}

double Reach(const Signal& u) {
  const auto [low, high] = std::minmax_element(u.begin(), u.end());
  return (*high - *low) / 2;
}
double Middle(const Signal& u) {
  const auto [low, high] = std::minmax_element(u.begin(), u.end());
  return (*high + *low) / 2;
}

Signal Larger(const Signal& u, double factor) {
  Signal out = u;
  for (double& v : out) v = u.front() + factor * (v - u.front());
  return out;
}

Signal Faster(const Signal& u, double factor) {
  Signal out = u;
  for (std::size_t k = 0; k < u.size(); ++k) {
    const auto at = static_cast<std::size_t>(factor * static_cast<double>(k));
    out[k] = u[std::min(at, u.size() - 1)];
  }
  return out;
}

Signal Staircase(const Signal& u) {
  Signal out = u;
  const std::size_t stair = std::max<std::size_t>(1, u.size() / 8);
  for (std::size_t k = 0; k < u.size(); ++k) out[k] = u[k - k % stair];
  return out;
}

// shape of the part x in [0, 1) of the log, about the middle of u.
Signal Shaped(const Signal& u, const std::function<double(double)>& shape) {
  Signal out = u;
  for (std::size_t k = 0; k < u.size(); ++k) {
    const double x = static_cast<double>(k) / static_cast<double>(u.size());
    out[k] = Middle(u) + Reach(u) * shape(x);
  }
  return out;
}

double Triangle(double turns) { return 2 / std::numbers::pi * std::asin(std::sin(kTau * turns)); }

std::vector<Variation> Library() {
  return {
      {"the same inputs half as large", [](const Signal& u) { return Larger(u, 0.5); }},
      {"the same inputs 1.5 times as large", [](const Signal& u) { return Larger(u, 1.5); }},
      {"the same inputs half as fast", [](const Signal& u) { return Faster(u, 0.5); }},
      {"the same inputs twice as fast", [](const Signal& u) { return Faster(u, 2); }},
      {"a staircase with rests", Staircase},
      {"slow reversals of growing amplitude",
       [](const Signal& u) { return Shaped(u, [](double x) { return x * Triangle(4 * x); }); }},
      {"a fast chirp of half the amplitude",
       [](const Signal& u) {
         return Shaped(u, [](double x) { return 0.5 * std::sin(kTau * (2 + 20 * x) * x); });
       }},
  };
}

class Proposal {
 public:
  Proposal(const CandidateFitter& fitter, const Diagnosis& d) : e_(*fitter.experiment), d_(d) {}

  NextExperiment Run() {
    NextExperiment best;
    for (const Variation& v : Library()) {
      Log log = Longest();
      if (!Apply(v, log)) continue;
      Consider(log, v.words, best);
    }
    for (const std::string& body : Ends()) {
      for (const double share : kWeights) {
        Log log = Longest();
        const double mass = TwoDigits(share * d_.sizes.mass);
        log.set.push_back({"body:" + body, "point_mass", mass, Change::Operation::kAdd});
        Consider(log, fmt::format("the same inputs with {:.2g} kg more at body {}", mass, body),
                 best);
      }
    }
    if (best.input.empty())
      best.input = "slow and fast motions over the whole range";
    else if (!Distinguishes(best.separation, d_.criteria)) {
      best.log.reset();
      best.input = "no change of these inputs distinguishes them (the best: " + best.input +
                   "): add a sensor, or fix one of them by a known mass or a separate measurement";
    }
    return best;
  }

 private:
  void Consider(const Log& log, const std::string& words, NextExperiment& best) const {
    double least = std::numeric_limits<double>::infinity();
    try {
      const std::size_t rivals =
          std::min(static_cast<std::size_t>(d_.criteria.next_rivals) + 1, d_.verdict.named.size());
      for (std::size_t i = 1; i < rivals; ++i)
        least = std::min(least, Distance(log, d_.candidates[d_.verdict.named[i]]));
    } catch (const Error&) {
      return;  // a simulation diverges under these inputs
    }
    if (best.input.empty() || least > best.separation) best = {words, least, log};
  }

  // Either may be the larger model, which can do what the other does.
  double Distance(const Log& log, const CandidateResult& rival) const {
    return std::max(Separation(log, *d_.chosen(), rival), Separation(log, rival, *d_.chosen()));
  }

  // λ of one candidate, refitted to first order to what another does in this log.
  double Separation(const Log& log, const CandidateResult& truth,
                    const CandidateResult& rival) const {
    Experiment e = e_;
    if (e.start == Experiment::Start::kEstimate) e.start = Experiment::Start::kRest;
    e.logs = {log};
    e.logs[0].train = true;
    e.logs[0].start.clear();
    e.logs[0].measured = Moves(e, truth);
    const Problem::Vector x = ValuesOf(rival);
    const Problem problem = ProblemFor(e, rival);
    const auto all = problem.AllLogs();
    const auto r = problem.Residuals(x, all);
    if (!r[0].allFinite()) throw Error::Job("diverged");
    const auto J = problem.Jacobian(x, r, all);
    const Whitening whitening = d_.noise.known() ? Whitening(problem, d_.noise) : Whitening();
    const std::vector<bool> free(static_cast<std::size_t>(x.size()), false);
    const ProjectedResidual residual(whitening, all, r, J, free, {Problem::Matrix(r[0].size(), 0)},
                                     d_.criteria);
    if (d_.noise.known()) return residual.cost();
    // In pooled units, which are those of the experiment's error.
    return residual.cost() / std::pow(d_.chosen()->fitted.error.train, 2);
  }

  std::vector<Signal> Moves(const Experiment& e, const CandidateResult& c) const {
    Trace trace = ProblemFor(e, c).Predict(ValuesOf(c), 0);
    if (trace.diverged) throw Error::Job("diverged");
    return std::move(trace.channel);
  }

  // A new log begins at rest.
  Problem::Vector ValuesOf(const CandidateResult& c) const {
    return ProblemOf(c, e_).WithoutStarts(c.fitted.fit.x);
  }

  Problem ProblemFor(const Experiment& e, const CandidateResult& c) const {
    Problem problem = ProblemOf(c, e);
    if (problem.Start().size() != ValuesOf(c).size())
      throw Error::Job("parameters of single logs say nothing about a new one");
    return problem;
  }

  // False when a limit of an actuator forbids it.
  bool Apply(const Variation& v, Log& log) const {
    const mjModel& m = d_.system.model();
    for (std::size_t i = 0; i < log.input.size(); ++i) {
      if (log.input[i].empty()) continue;
      log.input[i] = v.change(log.input[i]);
      const int id = mj_name2id(&m, mjOBJ_ACTUATOR, e_.inputs[i].actuator.c_str());
      if (id < 0 || !m.actuator_ctrllimited[id]) continue;
      const auto [low, high] = std::minmax_element(log.input[i].begin(), log.input[i].end());
      if (*low < m.actuator_ctrlrange[2 * id] || *high > m.actuator_ctrlrange[2 * id + 1])
        return false;
    }
    return true;
  }

  const Log& Longest() const {
    const Log* longest = nullptr;
    for (const Log& log : e_.logs) {
      if (log.train && (!longest || log.rows() > longest->rows())) longest = &log;
    }
    return *longest;
  }

  // Bodies that carry no other.
  std::vector<std::string> Ends() const {
    const mjModel& m = d_.system.model();
    std::vector<bool> carries(static_cast<std::size_t>(m.nbody), false);
    for (int b = 1; b < m.nbody; ++b) carries[m.body_parentid[b]] = true;
    std::vector<std::string> names;
    for (int b = 1; b < m.nbody; ++b) {
      const char* const name = mj_id2name(&m, mjOBJ_BODY, b);
      if (!carries[b] && name && *name) names.emplace_back(name);
    }
    return names;
  }

  const Experiment& e_;
  const Diagnosis& d_;
};

}  // namespace

NextExperiment ProposeNext(const CandidateFitter& fitter, const Diagnosis& diagnosis) {
  return diagnosis.verdict.named.size() < 2 ? NextExperiment{} : Proposal(fitter, diagnosis).Run();
}

std::string NextCsv(const Experiment& e, const Log& next) {
  std::vector<std::pair<std::string, Signal>> columns;
  const auto add = [&](const std::string& name, Signal values, double unit) {
    const auto same = [&](const auto& c) { return c.first == name; };
    if (name.empty() || std::any_of(columns.begin(), columns.end(), same)) return;
    for (double& v : values) v /= unit;
    columns.emplace_back(name, std::move(values));
  };
  Signal time = next.time;
  for (double& t : time) t -= next.time.front();
  add(e.time_column, std::move(time), UnitFactor(e.time_unit, "time"));
  for (std::size_t i = 0; i < e.inputs.size(); ++i) {
    const Input& in = e.inputs[i];
    add(in.column, next.input[i], UnitFactor(in.unit, in.where));
    add(in.enable, Signal(next.enable[i].begin(), next.enable[i].end()), 1);
  }
  std::string text;
  for (const auto& [name, values] : columns) text += (text.empty() ? "" : ",") + CsvCell(name);
  for (std::size_t k = 0; k < next.rows(); ++k) {
    for (std::size_t c = 0; c < columns.size(); ++c)
      text += (c ? "," : "\n") + Decimal(columns[c].second[k]);
  }
  return text + "\n";
}

}  // namespace continuum
