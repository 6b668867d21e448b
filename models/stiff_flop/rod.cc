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
  const Eigen::Vector3d& p;
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
Reaction<Dual> Seeded(const Module& module, const Method& method, const Eigen::Vector3d& p,
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

Rod::Rod(const Module& module, const Method& method, const Case& row, double fraction, int steps)
    : module_(module),
      method_(method),
      p_(fraction * row.given),
      force_(fraction * row.load.force),
      gravity_(fraction * row.load.gravity),
      steps_(steps),
      unit_(module.E * module.SecondMoment() / module.l),
      at_rest_(Rows(Seeded(module, method, Eigen::Vector3d::Zero(), {1, 0, 0}))
                   .leftCols<3>()
                   .determinant()) {}

void Rod::StartFrom(const Axis<double>& base) {
  base_ = base;
  cold_ = false;
}

// The section's root on the branch that starts unloaded: pressures and load rise together.
bool Rod::Raise(const Eigen::Vector3d& load, Eigen::Vector3d& x,
                const numerics::Options& options) const {
  const double r = module_.r_2;
  double fraction = 0;
  Axis<double> last{1, 0, 0};
  const auto at = [&](double next) {
    fraction = next;
    return SectionProblem{module_, method_, p_, load, next};
  };
  const auto on_branch = [&](const Eigen::Vector3d& root) {
    const Axis<double> axis{root[0], root[1] / r, root[2] / r};
    const auto rows = Rows(Seeded(module_, method_, fraction * p_, axis));
    if (rows.leftCols<3>().determinant() / at_rest_ <= 0) return false;
    if (IsJump(module_, last, axis)) return false;
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
  const double r = module_.r_2;
  Eigen::Vector3d x(section_.lambda, section_.k_1 * r, section_.k_2 * r);
  const SectionProblem problem{module_, method_, p_, load};
  const bool solved = cold_ ? Raise(load, x, options) : numerics::Newton(problem, x, options).ok();
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
  const SectionProblem problem{module_, method_, p_, load};
  const Eigen::Vector3d target = problem.Scaled(load);
  SolvedSection at = solved_[next_];
  const auto distance = [&](const SolvedSection& s) {
    return s.inverse.isZero(0) ? std::numeric_limits<double>::infinity()
                               : (s.load - target).squaredNorm();
  };
  if (next_ > 0 && distance(solved_[next_ - 1]) < distance(at)) at = solved_[next_ - 1];
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
  if (solved_.size() <= next_) solved_.resize(next_ + 1);
  if ((cold_ || !FollowNeighbour(load)) && !SearchSection(load)) return false;
  const Eigen::Vector3d& x = solved_[next_++].x;
  section_ = {x[0], x[1] / module_.r_2, x[2] / module_.r_2};
  cold_ = false;
  return true;
}

bool Rod::Strains(const Eigen::Vector3d& n, const Eigen::Vector3d& M, Strain<double>& strain) {
  if (!SolveSection({n[1], M[0], M[2]})) return false;
  const Axis<double>& u = section_;
  const auto reaction = ReactionOf(module_, method_, p_, module_.E, module_.gamma, u);
  const double G = module_.E / 3;
  strain.xi << n[0] / (G * reaction.area), u.lambda - 1, n[2] / (G * reaction.area);
  strain.zeta << -u.lambda * u.k_2, M[1] / (G * reaction.polar), -u.lambda * u.k_1;
  return true;
}

// The section's equations f(u, gamma, E) = load hold for all values of the seeds of the rod: u
// follows from du = f_u^-1 (dload - f_gamma dgamma - f_E dE).
bool Rod::Strains(const Eigen::Matrix<Dual, 3, 1>& n, const Eigen::Matrix<Dual, 3, 1>& M,
                  Strain<Dual>& strain) {
  if (!SolveSection({n[1].a, M[0].a, M[2].a})) return false;
  const Reaction<Dual> reaction = Seeded(module_, method_, p_, section_);
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
  const Dual G = Dual(module_.E, 4) / 3.0;
  const Dual shear = G * chain(reaction.area);
  strain.xi << n[0] / shear, lambda - 1.0, n[2] / shear;
  strain.zeta << -lambda * k_2, M[1] / (G * chain(reaction.polar)), -lambda * k_1;
  return true;
}

// The exact tangent of the section solved last.
void Rod::Keep(const Eigen::Matrix3d& inverse) {
  const double r = module_.r_2;
  const Eigen::Vector3d size(1, r, r);
  solved_[next_ - 1].inverse =
      size.asDiagonal() * inverse * size.asDiagonal() * (module_.E * module_.Area());
}

void Rod::Watch(const Eigen::Matrix3d& tangent) {
  reserve_.domain = std::min(reserve_.domain, Margin(module_, method_, section_));
  reserve_.stiffness = std::min(reserve_.stiffness, tangent.determinant() / at_rest_);
  // Rows n_y, M_x, M_z; columns lambda, k_1, k_2: M_x = -EK lambda k_2, M_z = -EK lambda k_1.
  const double x = -tangent(1, 2);
  const double z = -tangent(2, 1);
  const double cross = tangent(1, 1) * tangent(2, 2);
  reserve_.plain = reserve_.plain && tangent(0, 0) > 0 && x > 0 && z > 0 && x * z > cross;
}

Eigen::Vector3d Rod::Force(double s) const {
  return force_ + (module_.m_fs + module_.m * (1 - s / module_.l)) * gravity_;
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

template <class T>
bool Rod::Run(const Eigen::Vector3d& moment, State<T>& state, std::vector<State<double>>* states) {
  reserve_ = {};
  section_ = base_;
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
  State<T> slope = State<T>::Zero();
  bool carried = Slope(state, 0, slope);
  if (!carried) return false;
  base_ = section_;
  using namespace boost::numeric::odeint;
  runge_kutta_fehlberg78<State<T>, double, State<T>, double, vector_space_algebra> stepper;
  const auto system = [&](const State<T>& at, State<T>& out, double s) {
    carried = carried && Slope(at, s, out);
    if (!carried) out.setZero();
  };
  const double h = module_.l / steps_;
  for (int i = 0; carried && i < steps_; ++i) {
    stepper.do_step(system, state, i * h, h);
    if (states) states->push_back(state.unaryExpr([](const T& x) { return Value(x); }));
  }
  return carried;
}

bool Rod::Integrate(const Eigen::Vector3d& moment, State<double>& tip) {
  return Run(moment, tip, nullptr);
}

bool Rod::Integrate(const Eigen::Vector3d& moment, State<Dual>& tip) {
  return Run(moment, tip, nullptr);
}

std::vector<Rod::State<double>> Rod::States(const Eigen::Vector3d& moment) {
  State<double> tip = State<double>::Zero();
  tip[3] = 1;
  tip.tail<3>() = moment * unit_;
  std::vector<State<double>> states = {tip};
  if (!Run(moment, tip, &states)) states.clear();
  return states;
}

std::vector<Eigen::Vector3d> Rod::Line(const Eigen::Vector3d& moment) {
  std::vector<Eigen::Vector3d> line;
  for (const State<double>& state : States(moment)) line.emplace_back(state.head<3>());
  return line;
}

template <class T>
Eigen::Matrix<T, 3, 1> Rod::Tangent(const State<T>& state) {
  return Rotation(state).col(1);
}

template <class T>
Eigen::Matrix<T, 3, 1> Rod::Mismatch(const State<T>& tip) const {
  using Vector = Eigen::Matrix<T, 3, 1>;
  const Eigen::Vector3d load = module_.l_fs * (force_ + 0.5 * module_.m_fs * gravity_);
  const Vector moment = Tangent<T>(tip).cross(Vector(load.cast<T>()));
  const Vector mismatch = tip.template tail<3>() - moment;
  return mismatch * T(1 / unit_);
}

template Eigen::Vector3d Rod::Mismatch<double>(const State<double>&) const;
template Eigen::Matrix<Dual, 3, 1> Rod::Mismatch<Dual>(const State<Dual>&) const;
template Eigen::Vector3d Rod::Tangent<double>(const State<double>&);
template Eigen::Matrix<Dual, 3, 1> Rod::Tangent<Dual>(const State<Dual>&);

}  // namespace continuum::stiff_flop
