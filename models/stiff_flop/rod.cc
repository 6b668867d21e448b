#include "models/stiff_flop/rod.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <boost/numeric/odeint/algebra/vector_space_algebra.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_fehlberg78.hpp>

#include "models/stiff_flop/elastic.h"
#include "sim/numerics/continuation.h"
#include "sim/numerics/linearize.h"
#include "sim/numerics/newton.h"
#include "sim/numerics/solver.h"
#include "sim/numerics/work_limit.h"

namespace continuum::stiff_flop {
namespace {

using Dual = Rod::Dual;

// Closer than this to a fold a section counts as folded: its integrals would need more points than
// a search along such states is worth.
constexpr double kClosest = 1e-4;

/// Equilibrium of one section under a fraction of pressures and load, in x = (lambda, k_1 r_2,
/// k_2 r_2), forces per E a and moments per E a r_2.
struct SectionProblem {
  const Module& module;
  const Method& method;
  const Eigen::VectorXd& p;
  const Eigen::Vector3d& load;  // n_y, M_x, M_z
  double fraction = 1;

  template <class T>
  bool operator()(const T* x, T* f) const {
    for (int i = 0; i < 3; ++i) f[i] = T(0.0);
    const Axis<T> axis{x[0], x[1] / module.r_2, x[2] / module.r_2};
    if (!(Margin(module, method, axis.value()) > kClosest)) return false;
    const Reaction<T> reaction =
        ReactionOf(module, method, fraction * p, T(module.E), T(module.gamma), axis);
    const double unit = module.E * module.Area();
    f[0] = (reaction.n_y - fraction * load[0]) / unit;
    f[1] = (reaction.M_x - fraction * load[1]) / (unit * module.r_2);
    f[2] = (reaction.M_z - fraction * load[2]) / (unit * module.r_2);
    return true;
  }

  Eigen::Vector3d Scaled(const Eigen::Vector3d& v) const {
    return v.cwiseQuotient(Eigen::Vector3d(1, module.r_2, module.r_2)) / (module.E * module.Area());
  }
};

// Seeds: lambda, k_1, k_2, gamma, E.
Reaction<Dual> Seeded(const Module& module, const Method& method, const Eigen::VectorXd& p,
                      const Axis<double>& axis) {
  const Axis<Dual> seeded{Dual(axis.lambda, 0), Dual(axis.k_1, 1), Dual(axis.k_2, 2)};
  return ReactionOf(module, method, p, Dual(module.E, 4), Dual(module.gamma, 3), seeded);
}

// (n_y, M_x, M_z) by the five seeds.
Eigen::Matrix<double, 3, 5> Rows(const Reaction<Dual>& reaction) {
  Eigen::Matrix<double, 3, 5> rows;
  rows << reaction.n_y.v.transpose(), reaction.M_x.v.transpose(), reaction.M_z.v.transpose();
  return rows;
}

template <class T>
Eigen::Matrix<T, 3, 3> Rotation(const Rod::State<T>& state) {
  Eigen::Quaternion<T> turn(state[3], state[4], state[5], state[6]);
  turn.normalize();
  return turn.toRotationMatrix();
}

}  // namespace

bool IsJump(const Module& module, const Axis<double>& from, const Axis<double>& to) {
  const double turn = std::hypot(to.k_1 - from.k_1, to.k_2 - from.k_2) * module.r_2;
  return std::abs(to.lambda - from.lambda) > 0.2 * from.lambda || turn > 0.2;
}

bool IsJump(const ModuleSeries& series, const Axes& from, const Axes& to) {
  for (std::size_t i = 0; i < series.size(); ++i) {
    if (IsJump(series[i], from[i], to[i])) return true;
  }
  return false;
}

Axes Unstrained(const ModuleSeries& series) { return Axes(series.size(), Axis<double>{1, 0, 0}); }

Rod::Rod(const ModuleSeries& series, const Method& method, const Case& row, double fraction,
         int steps)
    : series_(series),
      method_(method),
      force_(fraction * row.load.force),
      gravity_(fraction * row.load.gravity),
      steps_(steps),
      unit_(series.unit()),
      known_(series.size(), false),
      bases_(Unstrained(series)) {
  for (std::size_t i = 0; i < series.size(); ++i) {
    p_.emplace_back(fraction * series.PressuresOf(i, row.given));
    const Eigen::VectorXd none = Eigen::VectorXd::Zero(p_.back().size());
    const auto rows = Rows(Seeded(series[i], method, none, {1, 0, 0}));
    at_rest_.push_back(rows.leftCols<3>().determinant());
  }
}

void Rod::StartFrom(const Axes& bases) {
  bases_ = bases;
  known_.assign(known_.size(), true);
}

// The section's root on the branch that starts unloaded: pressures and load rise together.
bool Rod::Raise(const Eigen::Vector3d& load, Eigen::Vector3d& x,
                const numerics::Options& options) const {
  const double r = module().r_2;
  double fraction = 0;
  Axis<double> last{1, 0, 0};
  const auto at = [&](double next) {
    fraction = next;
    return SectionProblem{module(), method_, p_[at_], load, next};
  };
  const auto on_branch = [&](const Eigen::Vector3d& root) {
    const Axis<double> axis{root[0], root[1] / r, root[2] / r};
    const auto rows = Rows(Seeded(module(), method_, fraction * p_[at_], axis));
    if (rows.leftCols<3>().determinant() / at_rest_[at_] <= 0) return false;
    if (IsJump(module(), last, axis)) return false;
    last = axis;
    return true;
  };
  return numerics::Continue(at, x, options, {}, on_branch).ok();
}

bool Rod::SearchSection(const Eigen::Vector3d& load) {
  numerics::Options options;
  options.tolerance = 1e-14;
  options.accept = 1e-12;
  options.max_iterations = 20;
  const double r = module().r_2;
  Eigen::Vector3d x(section_.lambda, section_.k_1 * r, section_.k_2 * r);
  const SectionProblem problem{module(), method_, p_[at_], load};
  const bool solved =
      !known_[at_] ? Raise(load, x, options) : numerics::Newton(problem, x, options).ok();
  if (!solved) return false;
  Eigen::Vector3d f;
  Eigen::Matrix3d tangent;
  if (!numerics::Linearize(problem, x, f, tangent)) return false;
  solved_[next_] = {x, problem.Scaled(load), tangent.inverse()};
  return true;
}

// From the section solved last or from this one in the integration before, whichever had the load
// more like this one: a step along the tangent, then Broyden's method, which needs no derivatives.
// Its last step is not looked at when the one before has shown where it ends.
bool Rod::FollowNeighbour(const Eigen::Vector3d& load) {
  constexpr int kMostRounds = 8;
  constexpr double kTolerance = 1e-14;
  const SectionProblem problem{module(), method_, p_[at_], load};
  const Eigen::Vector3d target = problem.Scaled(load);
  SolvedSection at = solved_[next_];
  const auto distance = [&](const SolvedSection& s) {
    return s.inverse.isZero(0) ? std::numeric_limits<double>::infinity()
                               : (s.load - target).squaredNorm();
  };
  if (next_ > first_ && distance(solved_[next_ - 1]) < distance(at)) at = solved_[next_ - 1];
  if (at.inverse.isZero(0)) return false;
  Eigen::Vector3d step = at.inverse * (target - at.load), f, before;
  at.x += step;
  double last = std::numeric_limits<double>::infinity();
  for (int round = 0; round < kMostRounds; ++round) {
    const double norm = numerics::NormAt(problem, at.x, f);
    if (!(norm < 0.5 * last)) return false;
    if (round > 0) {
      const Eigen::Vector3d moved = at.inverse * (f - before);
      const double along = step.dot(moved);
      if (along == 0) return false;
      at.inverse += (step - moved) * (step.transpose() * at.inverse) / along;
    }
    step = -at.inverse * f;
    at.x += step;
    const bool done = norm <= kTolerance || (round > 0 && norm * (norm / last) <= kTolerance);
    if (done) {
      at.load = target;
      solved_[next_] = at;
      return true;
    }
    before = f;
    last = norm;
  }
  return false;
}

bool Rod::SolveSection(const Eigen::Vector3d& load) {
  numerics::WorkLimit::Spend();
  if (solved_.size() <= next_) solved_.resize(next_ + 1);
  if ((!known_[at_] || !FollowNeighbour(load)) && !SearchSection(load)) return false;
  const Eigen::Vector3d& x = solved_[next_++].x;
  section_ = {x[0], x[1] / module().r_2, x[2] / module().r_2};
  known_[at_] = true;
  return true;
}

bool Rod::Strains(const Eigen::Vector3d& n, const Eigen::Vector3d& M, Strain<double>& strain) {
  if (!SolveSection({n[1], M[0], M[2]})) return false;
  const Axis<double>& u = section_;
  const auto reaction = ReactionOf(module(), method_, p_[at_], module().E, module().gamma, u);
  const double G = module().E / 3;
  strain.xi << n[0] / (G * reaction.area), u.lambda - 1, n[2] / (G * reaction.area);
  strain.zeta << -u.lambda * u.k_2, M[1] / (G * reaction.polar), -u.lambda * u.k_1;
  return true;
}

// The section's equations f(u, gamma, E) = load hold for all values of the seeds of the rod: u
// follows from du = f_u^-1 (dload - f_gamma dgamma - f_E dE).
bool Rod::Strains(const Eigen::Matrix<Dual, 3, 1>& n, const Eigen::Matrix<Dual, 3, 1>& M,
                  Strain<Dual>& strain) {
  if (!SolveSection({n[1].a, M[0].a, M[2].a})) return false;
  const Reaction<Dual> reaction = Seeded(module(), method_, p_[at_], section_);
  const Eigen::Matrix<double, 3, 5> rows = Rows(reaction);
  Watch(rows.leftCols<3>());
  Eigen::Matrix<double, 3, 5> load;
  load << n[1].v.transpose(), M[0].v.transpose(), M[2].v.transpose();
  load.rightCols<2>() -= rows.rightCols<2>();
  Eigen::Matrix<double, 5, 5> seeds = Eigen::Matrix<double, 5, 5>::Identity();
  const Eigen::FullPivLU<Eigen::Matrix3d> tangent(rows.leftCols<3>());
  seeds.topRows<3>() = tangent.solve(load);
  Keep(tangent.inverse());
  const auto chain = [&](const Dual& value) {
    return Dual(value.a, (value.v.transpose() * seeds).transpose());
  };
  const Dual lambda(section_.lambda, seeds.row(0).transpose());
  const Dual k_1(section_.k_1, seeds.row(1).transpose());
  const Dual k_2(section_.k_2, seeds.row(2).transpose());
  const Dual G = Dual(module().E, 4) / 3.0;
  const Dual shear = G * chain(reaction.area);
  strain.xi << n[0] / shear, lambda - 1.0, n[2] / shear;
  strain.zeta << -lambda * k_2, M[1] / (G * chain(reaction.polar)), -lambda * k_1;
  return true;
}

// The exact tangent of the section solved last.
void Rod::Keep(const Eigen::Matrix3d& inverse) {
  const double r = module().r_2;
  const Eigen::Vector3d size(1, r, r);
  solved_[next_ - 1].inverse =
      size.asDiagonal() * inverse * size.asDiagonal() * (module().E * module().Area());
}

void Rod::Watch(const Eigen::Matrix3d& tangent) {
  reserve_.domain = std::min(reserve_.domain, Margin(module(), method_, section_));
  reserve_.stiffness = std::min(reserve_.stiffness, tangent.determinant() / at_rest_[at_]);
  // Rows n_y, M_x, M_z; columns lambda, k_1, k_2: M_x = -EK lambda k_2, M_z = -EK lambda k_1.
  const double x = -tangent(1, 2);
  const double z = -tangent(2, 1);
  const double cross = tangent(1, 1) * tangent(2, 2);
  reserve_.plain = reserve_.plain && tangent(0, 0) > 0 && x > 0 && z > 0 && x * z > cross;
}

Eigen::Vector3d Rod::Force(double s) const {
  return series_.Above(at_, force_, gravity_) + module().m * (1 - s / module().l) * gravity_;
}

template <class T>
bool Rod::Slope(const State<T>& state, double s, State<T>& slope) {
  using Vector = Eigen::Matrix<T, 3, 1>;
  const Eigen::Matrix<T, 3, 3> R = Rotation(state);
  const Vector F = Force(s).cast<T>();
  const Vector M = state.template tail<3>();
  const Vector n = R.transpose() * F;
  const Vector local = R.transpose() * M;
  Strain<T> strain;
  if (!Strains(n, local, strain)) return false;
  Vector stretch = strain.xi;
  stretch[1] += T(1.0);
  const Vector step = R * stretch;
  slope.template head<3>() = step;
  const T &w = state[3], &a = state[4], &b = state[5], &c = state[6];
  const Vector half = strain.zeta * T(0.5);
  slope[3] = -a * half[0] - b * half[1] - c * half[2];
  slope[4] = w * half[0] + b * half[2] - c * half[1];
  slope[5] = w * half[1] + c * half[0] - a * half[2];
  slope[6] = w * half[2] + a * half[1] - b * half[0];
  slope.template tail<3>() = F.cross(step);
  return true;
}

// To the lower end of a module, along the mount of the one before it.
template <class T>
void Rod::Enter(std::size_t module, State<T>& state) {
  at_ = module;
  first_ = next_;
  section_ = bases_[module];
  if (module == 0) return;
  using Vector = Eigen::Matrix<T, 3, 1>;
  const Vector t = Tangent<T>(state);
  const Vector lever = series_.Lever(module - 1, force_, gravity_).template cast<T>();
  state.template head<3>() += t * T(series_[module - 1].l_fs);
  state.template tail<3>() -= t.cross(lever);
}

template <class T>
bool Rod::RunModule(State<T>& state, Stations* stations) {
  State<T> slope = State<T>::Zero();
  bool carried = Slope(state, 0, slope);
  if (!carried) return false;
  bases_[at_] = section_;
  const auto keep = [&] {
    if (stations) {
      stations->back().push_back(state.unaryExpr([](const T& x) { return Value(x); }));
    }
  };
  if (stations) stations->emplace_back();
  keep();
  using namespace boost::numeric::odeint;
  runge_kutta_fehlberg78<State<T>, double, State<T>, double, vector_space_algebra> stepper;
  const auto system = [&](const State<T>& at, State<T>& out, double s) {
    carried = carried && Slope(at, s, out);
    if (!carried) out.setZero();
  };
  const double h = module().l / steps_;
  for (int i = 0; carried && i < steps_; ++i) {
    stepper.do_step(system, state, i * h, h);
    keep();
  }
  return carried;
}

template <class T>
bool Rod::Run(const Eigen::Vector3d& moment, State<T>& state, Stations* stations) {
  reserve_ = {};
  next_ = 0;
  state.setZero();
  state[3] = T(1.0);
  for (int i = 0; i < 3; ++i) {
    if constexpr (std::is_same_v<T, double>) {
      state[7 + i] = moment[i] * unit_;
    } else {
      state[7 + i] = Dual(moment[i], i) * unit_;
    }
  }
  for (std::size_t i = 0; i < series_.size(); ++i) {
    Enter(i, state);
    if (!RunModule(state, stations)) return false;
  }
  return true;
}

bool Rod::Integrate(const Eigen::Vector3d& moment, State<double>& tip) {
  return Run(moment, tip, nullptr);
}

bool Rod::Integrate(const Eigen::Vector3d& moment, State<Dual>& tip) {
  return Run(moment, tip, nullptr);
}

std::vector<std::vector<Rod::State<double>>> Rod::States(const Eigen::Vector3d& moment) {
  State<double> tip;
  Stations stations;
  if (!Run(moment, tip, &stations)) stations.clear();
  return stations;
}

std::vector<Axes> Rod::Sections(const Eigen::Vector3d& moment) {
  std::vector<Axes> sections;
  const Stations stations = States(moment);
  solved_.clear();
  next_ = 0;
  for (at_ = 0; at_ < stations.size(); ++at_) {
    sections.emplace_back();
    first_ = next_;
    section_ = bases_[at_];
    for (std::size_t i = 0; i < stations[at_].size(); ++i) {
      const State<double>& state = stations[at_][i];
      const Eigen::Matrix3d R = Rotation(state);
      const Eigen::Vector3d n = R.transpose() * Force(module().l * static_cast<double>(i) / steps_);
      const Eigen::Vector3d M = R.transpose() * state.tail<3>();
      if (!SolveSection({n[1], M[0], M[2]})) return {};
      sections.back().push_back(section_);
    }
  }
  return sections;
}

std::vector<std::vector<Eigen::Vector3d>> Rod::Lines(const Eigen::Vector3d& moment) {
  std::vector<std::vector<Eigen::Vector3d>> lines;
  for (const auto& states : States(moment)) {
    lines.emplace_back();
    for (const State<double>& state : states) lines.back().emplace_back(state.head<3>());
  }
  return lines;
}

template <class T>
Eigen::Matrix<T, 3, 1> Rod::Tangent(const State<T>& state) {
  return Rotation(state).col(1);
}

template <class T>
Eigen::Matrix<T, 3, 1> Rod::Mismatch(const State<T>& tip) const {
  using Vector = Eigen::Matrix<T, 3, 1>;
  const Eigen::Vector3d load = series_.Lever(series_.size() - 1, force_, gravity_);
  const Vector moment = Tangent<T>(tip).cross(Vector(load.cast<T>()));
  const Vector mismatch = tip.template tail<3>() - moment;
  return mismatch * T(1 / unit_);
}

template Eigen::Vector3d Rod::Mismatch<double>(const State<double>&) const;
template Eigen::Matrix<Dual, 3, 1> Rod::Mismatch<Dual>(const State<Dual>&) const;
template Eigen::Vector3d Rod::Tangent<double>(const State<double>&);
template Eigen::Matrix<Dual, 3, 1> Rod::Tangent<Dual>(const State<Dual>&);

}  // namespace continuum::stiff_flop
