// How the residuals of a problem follow its parameters.
#include <algorithm>
#include <memory>
#include <numeric>

#include "identification/problem/problem.h"
#include "identification/problem/trace_bytes.h"
#include "identification/sensitivity/smooth_path.h"
#include "sim/io/interrupt.h"
#include "sim/numerics/shared_loop.h"
#include "sim/simulation/trace_measurement.h"

namespace continuum {
std::vector<Problem::Matrix> Problem::Jacobian(const Vector& x, const std::vector<Vector>& r,
                                               const std::vector<bool>& use,
                                               const std::vector<Matrix>& known, bool rough) const {
  std::vector<Matrix> J(use.size());
  const auto motions = Motions(use);
  std::size_t first = 0;
  for (std::size_t l = 0; l < use.size(); ++l) {
    if (!use[l]) continue;
    J[l] = Matrix::Zero(r[l].size(), x.size());
    if (known.empty()) continue;
    first = static_cast<std::size_t>(known[l].cols());
    J[l].leftCols(known[l].cols()) = known[l];
  }
  std::vector<std::size_t> columns;
  for (std::size_t k = first; k < parameters_.size(); ++k) {
    if (path_ == Path::kStepped || IsOfMeasurement(k)) columns.push_back(k);
  }
  DifferenceColumns(x, r, motions, columns, J);
  if (path_ == Path::kSmooth) SensitivityColumns(x, motions, first, rough, J);
  return J;
}

std::vector<Problem::Matrix> Problem::StartJacobian(const Vector& x, const std::vector<Vector>& r,
                                                    const std::vector<bool>& use) const {
  std::vector<Matrix> J(use.size());
  for (std::size_t l = 0; l < use.size(); ++l) {
    if (use[l]) J[l] = Matrix::Zero(r[l].size(), x.size());
  }
  std::vector<std::size_t> columns;
  for (std::size_t k = 0; k < parameters_.size(); ++k) {
    if (parameters_[k].IsStart()) columns.push_back(k);
  }
  DifferenceColumns(x, r, Motions(use), columns, J);
  return J;
}

// Whether a parameter changes how a motion is measured, not the motion.
bool Problem::IsOfMeasurement(std::size_t k) const {
  return SideOf(parameters_[k].change) == Side::kMeasurement;
}

std::vector<std::size_t> Problem::ActingColumns(const std::vector<std::size_t>& columns,
                                                std::size_t log) const {
  std::vector<std::size_t> acting;
  for (const std::size_t k : columns) {
    if (parameters_[k].log[log]) acting.push_back(k);
  }
  return acting;
}

bool Problem::WithinBounds(std::size_t k, double value) const {
  return value >= parameters_[k].lower && value <= parameters_[k].upper;
}

double Problem::StepOf(const Vector& x, std::size_t k, double share) const {
  const double step = share * parameters_[k].scale;
  const double above = parameters_[k].upper - x[k], below = x[k] - parameters_[k].lower;
  if (step <= above) return step;
  if (step <= below || std::max(above, below) <= 0) return -step;
  return above > below ? above : -below;
}

std::vector<std::size_t> Problem::TakeClosedForms(const Vector& x,
                                                  const std::vector<std::size_t>& motion,
                                                  const std::vector<std::size_t>& columns,
                                                  std::size_t thread, Trace& here,
                                                  std::vector<Matrix>& J) const {
  using Way = Derivative::Way;
  const std::vector<Derivative> made = ClosedFormColumns(x, motion, columns, thread, here, J);
  std::vector<std::size_t> left;
  for (std::size_t j = 0; j < columns.size(); ++j) {
    if (made[j].way == Way::kDifferences || made[j].way == Way::kMeasurement)
      left.push_back(columns[j]);
  }
  return left;
}

void Problem::DifferenceColumns(const Vector& x, const std::vector<Vector>& r,
                                const std::vector<std::vector<std::size_t>>& motions,
                                const std::vector<std::size_t>& columns,
                                std::vector<Matrix>& J) const {
  std::vector<std::vector<std::size_t>> left(motions.size());
  const auto closed_form = [&](std::size_t thread, std::size_t i) {
    Trace here;
    left[i] =
        TakeClosedForms(x, motions[i], ActingColumns(columns, motions[i].front()), thread, here, J);
  };
  ShareOut(motions.size(), closed_form, [&](auto& archive, std::size_t i) {
    archive(left[i]);
    for (const std::size_t k : ActingColumns(columns, motions[i].front())) {
      if (std::find(left[i].begin(), left[i].end(), k) != left[i].end()) continue;
      for (const std::size_t l : motions[i]) FieldsOfBlock(archive, J[l].col(k));
    }
  });
  std::size_t exact = 0;  // simulations that gave columns in closed form
  for (std::size_t i = 0; i < motions.size(); ++i)
    exact += left[i].size() < ActingColumns(columns, motions[i].front()).size();
  Count(exact);
  DifferTheOthers(x, r, motions, left, J);
}

bool Problem::LinearisesCheaply() const {
  return path_ == Path::kStepped && system().model().nplugin == 0 &&
         NotTried(Start(), 0, parameters_.size()).empty();
}

Problem::Linearised Problem::Linearise(const Vector& x, const std::vector<bool>& use) const {
  const auto motions = Motions(use);
  std::vector<std::size_t> all(parameters_.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  Linearised out{std::vector<Vector>(use.size()), std::vector<Matrix>(use.size())};
  for (std::size_t l = 0; l < use.size(); ++l) {
    if (!use[l]) continue;
    const std::size_t rows = experiment_->logs[l].rows() * channels_.size();
    out.J[l] = Matrix::Zero(static_cast<Eigen::Index>(rows), x.size());
  }
  std::vector<std::vector<std::size_t>> left(motions.size());
  std::vector<LastRun> made(motions.size());
  const auto simulate = [&](std::size_t thread, std::size_t i) {
    const std::size_t first = motions[i].front();
    made[i] = MadeOf(x, first, MeasuredBy(x, first).skew);
    Trace& here = made[i].trace;
    left[i] = TakeClosedForms(x, motions[i], ActingColumns(all, first), thread, here, out.J);
    if (here.channel.empty()) here = Run(thread, x, first);
    for (const std::size_t l : motions[i]) out.r[l] = ResidualOf(l, here);
  };
  ShareOut(motions.size(), simulate, [&](auto& archive, std::size_t i) {
    archive(left[i], made[i]);
    for (const std::size_t l : motions[i]) archive(out.r[l], out.J[l]);
  });
  Keep(motions, std::move(made));
  Count(motions.size());
  const auto is_measured = [&](std::size_t k) { return IsOfMeasurement(k); };
  const bool whole = std::all_of(left.begin(), left.end(), [&](const auto& some) {
    return std::all_of(some.begin(), some.end(), is_measured);
  });
  if (!whole) return {std::move(out.r), {}};
  DifferTheOthers(x, out.r, motions, left, out.J);
  return out;
}

void Problem::DifferTheOthers(const Vector& x, const std::vector<Vector>& r,
                              const std::vector<std::vector<std::size_t>>& motions,
                              const std::vector<std::vector<std::size_t>>& left,
                              std::vector<Matrix>& J) const {
  std::vector<std::pair<std::size_t, std::size_t>> tasks;  // motion, parameter
  for (std::size_t i = 0; i < motions.size(); ++i)
    for (const std::size_t k : left[i]) tasks.emplace_back(i, k);
  const auto differ = [&](std::size_t thread, std::size_t t) {
    if (StopRequested()) return;
    const std::size_t i = tasks[t].first, k = tasks[t].second;
    double step = StepOf(x, k, share_);
    const auto moved = [&](double by) {
      const std::size_t log = motions[i].front();
      Vector beside = x;
      beside[k] += by;
      LastRun run = MadeOf(beside, log, MeasuredBy(beside, log).skew);
      run.trace = Run(thread, beside, log);
      Trace trace = run.trace;
      if (path_ == Path::kStepped) runs_.KeepBehind(motion_[log], std::move(run));
      return trace;
    };
    const bool room = WithinBounds(k, x[k] - step);
    Trace there = moved(step), back;
    bool both = central_ && room;
    if (both) back = moved(-step);
    if (both && back.diverged) both = false;
    if (there.diverged && room) {  // at the edge of what can be simulated: to the other side
      there = central_ ? std::move(back) : moved(-step);
      step = -step, both = false;
    }
    for (const std::size_t l : motions[i])
      J[l].col(k) = both ? (ResidualOf(l, there) - ResidualOf(l, back)) / (2 * step)
                         : (ResidualOf(l, there) - r[l]) / step;
  };
  ShareOut(tasks.size(), differ, [&](auto& archive, std::size_t t) {
    for (const std::size_t l : motions[tasks[t].first])
      FieldsOfBlock(archive, J[l].col(tasks[t].second));
  });
  Count((central_ ? 2 : 1) * tasks.size());
}

std::vector<std::unique_ptr<ContinuousDynamics>> Problem::DynamicsBeside(
    std::size_t thread, const Vector& x, std::size_t log,
    const std::vector<std::size_t>& columns) const {
  std::vector<std::unique_ptr<ContinuousDynamics>> beside;
  for (const std::size_t k : columns) {
    Vector moved = x;
    moved[k] += StepOf(x, k, kPerturbation);
    beside.push_back(DynamicsAt(thread, moved, log));
  }
  return beside;
}

// Parameters of a motion are shared out so that no core waits for another; in the same way on any
// number of cores, as the tolerance holds for those of a task together.
void Problem::SensitivityColumns(const Vector& x,
                                 const std::vector<std::vector<std::size_t>>& motions,
                                 std::size_t first, bool rough, std::vector<Matrix>& J) const {
  struct Task {
    std::size_t motion;
    std::vector<std::size_t> moving;
  };
  std::vector<Task> tasks;
  constexpr std::size_t kCores = 2;
  const std::size_t shares = kCores / std::gcd(motions.size(), kCores);
  for (std::size_t i = 0; i < motions.size(); ++i) {
    std::vector<std::size_t> moving;
    for (std::size_t k = first; k < parameters_.size(); ++k) {
      if (!IsOfMeasurement(k)) moving.push_back(k);
    }
    moving = ActingColumns(moving, motions[i].front());
    for (std::size_t s = 0; s < shares; ++s) {
      const auto at = [&](std::size_t share) {
        return moving.begin() + static_cast<std::ptrdiff_t>(share * moving.size() / shares);
      };
      if (at(s) != at(s + 1)) tasks.push_back({i, {at(s), at(s + 1)}});
    }
  }
  SolverOptions how = solver_;
  if (rough) how.relative = 1e-3, how.absolute = 1e-5;
  const auto integrate = [&](std::size_t thread, std::size_t t) {
    if (StopRequested()) return;
    const auto& [i, moving] = tasks[t];
    const std::size_t log = motions[i].front();
    const auto perturbed = DynamicsBeside(thread, x, log, moving);
    const auto dynamics = DynamicsAt(thread, x, log);
    const Log& logged = experiment_->logs[log];
    const Experiment measured = MeasuredBy(x, log);
    SmoothTraces traces = SimulateSmooth(*dynamics, perturbed, measured, logged, how);
    for (std::size_t j = 0; j < moving.size(); ++j) {
      MeasureTrace(measured, dynamics->wiring(), logged, traces.perturbed[j]);
      for (const std::size_t l : motions[i]) {
        J[l].col(moving[j]) = (ResidualOf(l, traces.perturbed[j]) - ResidualOf(l, traces.trace)) /
                              StepOf(x, moving[j], kPerturbation);
      }
    }
  };
  ShareOut(tasks.size(), integrate, [&](auto& archive, std::size_t t) {
    for (const std::size_t l : motions[tasks[t].motion]) {
      for (const std::size_t k : tasks[t].moving) FieldsOfBlock(archive, J[l].col(k));
    }
  });
  Count(tasks.size());
}

}  // namespace continuum
