#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "identification/problem/last_runs.h"
#include "identification/result/derivatives.h"
#include "identification/result/free_parameter.h"
#include "identification/sensitivity/solver_options.h"
#include "sim/simulation/score.h"
#include "sim/simulation/simulate.h"

namespace continuum {

class ContinuousDynamics;
class Error;
struct PerturbedRun;

/// A force on the joints that is linear in parameters of its own: a placebo, or the best that any
/// smooth law could do. Its parameters follow the others.
struct ForceTerms {
  /// Adds Σ θ_k φ_k(state) to qfrc_applied.
  std::function<void(const mjModel&, mjData&, std::span<const double> theta)> add;
  std::size_t count = 0;
  double size = 1;  ///< typical θ [N*m]
};

/// Which logs a fit may see.
std::vector<bool> TrainLogs(const Experiment& experiment);

/// Residuals of an experiment's logs as functions of the parameters of one model.
///
/// Residuals are (simulated − measured)/scale · sqrt(weight) over all counted channels of a log,
/// row by row; scale is sigma where every output gives it, else the pooled unit. Rows that were not
/// measured give zero. Evaluations run on all cores, and several threads may ask for them at once.
class Problem {
 public:
  using Vector = Eigen::VectorXd;
  using Matrix = Eigen::MatrixXd;

  /// extra: parameters beyond the experiment's own; seen: the logs of the fit, empty: those that
  /// train. Throws Error (key and file) for targets that match nothing, starts outside the bounds
  /// and values of single logs or conditions that no log of the fit determines.
  Problem(const Experiment& experiment, const ModelSpec& system, std::vector<Parameter> extra = {},
          ForceTerms terms = {}, std::vector<bool> seen = {});
  /// From now on along this path (SmoothObstacle says where the smooth one cannot go).
  void Follow(Path path);
  /// From now on with this time step [s] instead of the model's.
  void StepBy(double h);
  double step() const;  ///< [s]
  /// Takes over the simulations that a problem with the same model, but for parameters of the
  /// measurement, remembers: each log's last one.
  void Recall(const Problem& other) { runs_ = other.runs_; }
  /// From now on with central differences, at twice the cost; one-sided where a bound is near.
  void Center() { central_ = true; }
  /// From now on every simulation of a log with hooks of its own, as to set its state on the way;
  /// without sensitivities in closed form.
  void Guide(std::function<Hooks(std::size_t log)> hooks);
  /// From now on with differences over this share of a parameter's scale, nothing in closed form.
  /// The default share averages over the kinks of joints that stick and slip step by step; 1e-6
  /// gives the derivative itself.
  void DifferBy(double share) { share_ = share, exact_ = false; }

  /// Why sensitivities of the stepped path come from differences ("as asked for"); empty: they
  /// have a closed form, but for parameters that the motion follows in other ways.
  std::string NoClosedForm() const;

  const Experiment& experiment() const { return *experiment_; }
  /// Of one thread of parallel work; all are alike.
  const ModelSpec& system(std::size_t thread = 0) const { return systems_[thread]; }
  const std::vector<FreeParameter>& parameters() const { return parameters_; }
  Vector Start() const;
  Vector Clamp(const Vector& x) const;
  /// A step of one parameter by a share of its scale: downward where upward would leave its bounds,
  /// and to the farther bound where both would.
  double StepOf(const Vector& x, std::size_t k, double share) const;

  /// Parameters without where the trials begin.
  Vector WithoutStarts(const Vector& x) const;

  /// Residuals of the logs marked in use; other entries are empty. A diverged log gives NaN.
  std::vector<Vector> Residuals(const Vector& x, const std::vector<bool>& use) const;
  /// Residuals, and their Jacobian where one simulation of each motion gives both.
  struct Linearised {
    std::vector<Vector> r;
    std::vector<Matrix> J;  ///< none: some columns take differences
  };
  Linearised Linearise(const Vector& x, const std::vector<bool>& use) const;
  /// Whether that is worth it before a step is known to be good: no effect of ours makes the slopes
  /// dearer than the simulation.
  bool LinearisesCheaply() const;
  /// What the time step h leaves open, one column each: residuals at h less those at h/4; what all
  /// channels change when they come one step later (r: residuals at x); by how much residuals at h
  /// less those at h/2 are not 2/3 of the first, as they are to first order in h. Zero where a
  /// finer simulation diverges.
  std::vector<Matrix> StepEffects(const Vector& x, const std::vector<Vector>& r,
                                  const std::vector<bool>& use) const;
  /// d residual / d parameter [per unit of the parameter] of each log, by one-sided differences or
  /// sensitivities; r: the residuals at x; known: its leading columns, when they are known already;
  /// rough: to two digits, on the smooth path: enough to search with, as residuals stay exact.
  /// Once the user has asked to stop, columns that are left are zero.
  std::vector<Matrix> Jacobian(const Vector& x, const std::vector<Vector>& r,
                               const std::vector<bool>& use, const std::vector<Matrix>& known = {},
                               bool rough = false) const;
  /// How each column of it is made at x [parameter][log]; entries of logs not in use and of
  /// parameters that do not act there are in closed form. Simulates every log.
  std::vector<std::vector<Derivative>> WaysOf(const Vector& x, const std::vector<bool>& use) const;
  /// The same Jacobian, but only with respect to where the trials begin; other columns are zero.
  std::vector<Matrix> StartJacobian(const Vector& x, const std::vector<Vector>& r,
                                    const std::vector<bool>& use) const;
  /// Pooled RMS (unit: see Pool) of residuals over all measured samples of the logs in use.
  double PooledRms(const std::vector<Vector>& r, const std::vector<bool>& use) const;
  /// What the model says about one log.
  Trace Predict(const Vector& x, std::size_t log) const;
  /// The experiment's outputs and clock as one log is measured; without logs.
  Experiment MeasuredBy(const Vector& x, std::size_t log) const;
  /// The changes that make the model of one log.
  std::vector<Change> ChangesFor(const Vector& x, std::size_t log) const;
  /// Where the trial of one log begins; empty: as the experiment says.
  InitialState StartAt(ModelAndData& machine, const Vector& x, std::size_t log) const;
  /// The changes that hold for every log alike: those of the model file to be written.
  std::vector<Change> CommonChanges(const Vector& x) const;

  std::vector<bool> AllLogs() const { return std::vector<bool>(experiment_->logs.size(), true); }
  std::vector<bool> TrainLogs() const { return continuum::TrainLogs(*experiment_); }
  /// The logs of the fit.
  const std::vector<bool>& seen() const { return seen_; }
  Path path() const { return path_; }
  /// Simulations run so far; within parallel work those of its own thread.
  std::size_t evaluations() const;
  /// Counted channels, in the order in which their rows follow each other in a residual vector.
  const std::vector<std::size_t>& channels() const { return channels_; }
  /// SI per residual unit of a counted channel.
  double scale(std::size_t counted) const { return scale_[counted]; }
  /// The logs in use by the simulation that they share: replicates, unless they start as measured.
  std::vector<std::vector<std::size_t>> Motions(const std::vector<bool>& use) const;

 private:
  void FindScales();
  void Expand(const Parameter& p);
  void ExpandGroups(const Parameter& p, const FreeParameter& free);
  /// What the model or the experiment has.
  double PresentValue(const Parameter& p) const;
  std::string GroupOf(const Parameter& p, const Log& log) const;
  void RequireSeen(const Parameter& p) const;
  bool SameMotion(std::size_t a, std::size_t b) const;
  Trace Run(std::size_t thread, const Vector& x, std::size_t log, double step = 0) const;
  ModelAndData ModelAt(std::size_t thread, const Vector& x, std::size_t log, double step) const;
  Trace Rejected(const Log& log, const Error& error) const;
  Log Stretched(const Log& logged, double skew) const;
  std::unique_ptr<ContinuousDynamics> DynamicsAt(std::size_t thread, const Vector& x,
                                                 std::size_t log) const;
  bool IsOfMeasurement(std::size_t k) const;
  /// Within the parameter's bounds.
  bool WithinBounds(std::size_t k, double value) const;
  void DifferenceColumns(const Vector& x, const std::vector<Vector>& r,
                         const std::vector<std::vector<std::size_t>>& motions,
                         const std::vector<std::size_t>& columns, std::vector<Matrix>& J) const;
  /// Those that no closed form gives: left [motion], parameters.
  void DifferTheOthers(const Vector& x, const std::vector<Vector>& r,
                       const std::vector<std::vector<std::size_t>>& motions,
                       const std::vector<std::vector<std::size_t>>& left,
                       std::vector<Matrix>& J) const;
  /// Writes the columns of a motion that have a closed form, and the trace at x if there are any;
  /// returns the others.
  std::vector<std::size_t> TakeClosedForms(const Vector& x, const std::vector<std::size_t>& motion,
                                           const std::vector<std::size_t>& columns,
                                           std::size_t thread, Trace& here,
                                           std::vector<Matrix>& J) const;
  PerturbedRun RunOf(ModelAndData machine, const Vector& x, std::size_t log) const;
  /// Those of columns whose parameters act in a log.
  std::vector<std::size_t> ActingColumns(const std::vector<std::size_t>& columns,
                                         std::size_t log) const;
  std::string NotTried(const Vector& x, std::size_t log, std::size_t columns) const;
  PerturbedRun RunBeside(const mjModel& m, const Vector& x, std::size_t log, std::size_t k,
                         std::size_t thread) const;
  Derivative TakeColumn(const Vector& x, const std::vector<std::size_t>& motion, std::size_t k,
                        const PerturbedRun& run, const Trace& here, const Trace& there,
                        std::vector<Matrix>& J) const;
  std::vector<Derivative> SteppedColumns(const Vector& x, const std::vector<std::size_t>& motion,
                                         const std::vector<std::size_t>& columns,
                                         std::size_t thread, Trace& here,
                                         std::vector<Matrix>& J) const;
  /// By StepSensitivity, one simulation for all columns, whose trace is here; returns how each is
  /// made. Those by differences and of the measurement are left out of J.
  std::vector<Derivative> ClosedFormColumns(const Vector& x, const std::vector<std::size_t>& motion,
                                            const std::vector<std::size_t>& columns,
                                            std::size_t thread, Trace& here,
                                            std::vector<Matrix>& J) const;
  std::vector<Derivative> SmoothColumns(const Vector& x, std::size_t log,
                                        const std::vector<std::size_t>& columns) const;
  std::vector<std::unique_ptr<ContinuousDynamics>> DynamicsBeside(
      std::size_t thread, const Vector& x, std::size_t log,
      const std::vector<std::size_t>& columns) const;
  void SensitivityColumns(const Vector& x, const std::vector<std::vector<std::size_t>>& motions,
                          std::size_t first, bool rough, std::vector<Matrix>& J) const;
  enum class Side { kModel, kMeasurement, kStart };
  static Side SideOf(const Change& change);
  std::vector<Change> ChangesAt(const Vector& x, std::size_t log, Side side) const;
  Vector ResidualOf(std::size_t log, const Trace& trace) const;
  Trace Delayed(const Trace& trace, const Vector& x, std::size_t log, double delay) const;
  /// What a simulation of a log is made of; without its trace.
  LastRun MadeOf(const Vector& x, std::size_t log, double skew) const;
  /// Remembers what each motion was simulated of.
  void Keep(const std::vector<std::vector<std::size_t>>& motions, std::vector<LastRun> made) const;
  void Count(std::size_t simulations) const;

  const Experiment* experiment_;
  std::vector<bool> seen_;
  std::vector<ModelSpec> systems_;  ///< one per thread
  Experiment setup_;                ///< without logs
  mutable LastRuns runs_;
  std::vector<std::size_t> motion_;  ///< [log] the first log that moves alike: repeats run once
  std::vector<FreeParameter> parameters_;
  std::vector<Change> frozen_;
  std::vector<std::size_t> channels_;
  std::vector<double> scale_;   ///< SI per residual unit, of each counted channel
  std::vector<double> pooled_;  ///< pooled units per residual unit
  ForceTerms terms_;
  std::function<Hooks(std::size_t log)> guide_;
  Path path_ = Path::kStepped;
  double step_ = 0;  ///< 0: the model's
  bool central_ = false;
  double share_ = 1e-3;
  bool exact_ = true;                             ///< in closed form where there is one
  SolverOptions solver_;                          ///< on the smooth path
  mutable std::vector<std::size_t> evaluations_;  ///< [thread] that asked for them
};

double SumOfSquares(const std::vector<Eigen::VectorXd>& residuals);

}  // namespace continuum
