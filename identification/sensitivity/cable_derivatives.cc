#include "identification/sensitivity/cable_derivatives.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "binding/force.h"
#include "sim/model/point_jacobian.h"

namespace continuum {
namespace {

using Kind = Number::Kind;
using Vector3 = Eigen::Vector3d;

// The last joint that moves what both joints move; −1: none.
int Common(const mjModel& m, int a, int b) {
  while (a != b) {
    int& deeper = a > b ? a : b;
    deeper = m.dof_parentid[deeper];
  }
  return a;
}

// Along a segment; how a change of its direction along x follows that of where it ends.
struct Direction {
  Vector3 u;
  double length;
  Direction(const mjData& d, int near, int far)
      : u(Vector3(d.site_xpos + 3 * far) - Vector3(d.site_xpos + 3 * near)),
        length(std::max(u.norm(), mjMINVAL)) {
    u /= length;
  }
  Vector3 Turned(const Vector3& x) const { return (x - u.dot(x) * u) / length; }
};

// Of the wrap angle at the second of three sites, sin(θ/2) = |b − a|/2: only joints between the
// sites bend the cable there.
Eigen::RowVectorXd AngleTangents(const mjModel& m, const mjData& d, const int* sites,
                                 const Tangents& position) {
  Eigen::RowVectorXd change = Eigen::RowVectorXd::Zero(position.cols());
  const Direction a(d, sites[0], sites[1]), b(d, sites[1], sites[2]);
  const double size = (b.u - a.u).norm(), cosine = 0.5 * (a.u + b.u).norm();
  if (size < 1e-12) return change;
  const Vector3 apart = (b.u - a.u) / (size * std::max(cosine, 1e-12));
  const Vector3 before = a.Turned(apart), behind = b.Turned(apart);
  const Vector3 along[] = {before, -before - behind, behind};
  const auto last = [&](int k) { return LastDof(m, m.site_bodyid[sites[k]]); };
  const int common = Common(m, Common(m, last(0), last(1)), last(2));
  for (int k = 0; k < 3; ++k) {
    const Vector3 at(d.site_xpos + 3 * sites[k]);
    for (int i = last(k); i != common; i = m.dof_parentid[i])
      change += along[k].dot(PointJacobian(m, d, i, at)) * position.row(i);
  }
  return change;
}

// Where nothing has friction, as in a straight cable, the law leaves bends as they were: all slide
// with the tension of the base.
int SideOf(const Bend& bend) { return bend.band > 0 ? bend.side : 1; }

// r of the side on which a bend slides.
double SideRatio(const Bend& bend) { return bend.side > 0 ? bend.grown : 1 / bend.grown; }

// Of the ratio of a bend that slides by its band.
double SlidingSlope(const Bend& bend) {
  if (bend.band == 0) return 1;
  return bend.side * ((1 - bend.turned) * SideRatio(bend) - bend.turned / SideRatio(bend));
}

}  // namespace

CableDerivatives::CableDerivatives(const mjModel& m, const ForceDerivatives::Parts& parts)
    : derivatives_(m, parts), curvature_(m.nv, m.nv) {}

double CableDerivatives::TensionOf(std::size_t g) const {
  const auto rough = [](const Bend& bend) { return bend.band > 0; };
  const Bend& bend = bends_[g];
  return std::any_of(bends_.begin(), bends_.end(), rough) ? bend.tension
                                                          : law_.law->base()[bend.cable];
}

void CableDerivatives::Begin(const mjModel& m, const mjData& d, const Law& law,
                             std::span<const double> pull, const std::vector<double>& given) {
  law_ = law;
  bends_ = law.law->bends(), give_way_ = law.law->sliding().give_way();
  rests_ = std::any_of(bends_.begin(), bends_.end(), [](const Bend& b) { return SideOf(b) == 0; });
  Take(m, d, law.law->sliding().change(), pull, given);
}

void CableDerivatives::BeginTurn(const mjModel& m, const mjData& d, const Law& law,
                                 std::span<const double> pull, const std::vector<double>& given) {
  const CableSliding::Turn& turn = law.law->sliding().turn();
  law_ = law;
  bends_ = turn.bends, give_way_ = turn.give_way;
  rests_ = true;
  Take(m, d, turn.velocity, pull, given);
}

// change: x; empty where the law found nothing: yields are not finite then.
void CableDerivatives::Take(const mjModel& m, const mjData& d, std::span<const double> change,
                            std::span<const double> pull, const std::vector<double>& given) {
  after_.assign(d.qvel, d.qvel + m.nv), rate_.assign(m.nv, 0);
  derivatives_.Place(m, d);
  if (!rests_ || change.empty()) return;
  const StepInertia& inertia = law_.law->sliding().inertia();
  for (int i = 0; i < inertia.size(); ++i) {
    const int dof = inertia.dofs()[i];
    after_[dof] += change[i];
    rate_[dof] = change[i] / m.opt.timestep;
  }
  derivatives_.Pull(pull);
  derivatives_.Give(given);
  derivatives_.Update(m, d, rate_.data(), after_.data(), m.opt.timestep);
}

// Up to dt_g and dv_g⁺ at the same x; returns dF, with what the routes' curvatures add.
Tangents CableDerivatives::AllTangents(const mjModel& m, const mjData& d,
                                       const NumberTangents& numbers, const Tangents& other) {
  FollowBands(m, d, numbers);
  FollowBases(m, d, numbers);
  FollowRatios(numbers);
  AddCurvatures(m);
  pulled_.setZero(m.nv, std::ssize(bends_));
  speed_.setZero(std::ssize(bends_), other.cols());
  speed_after_.assign(bends_.size(), 0);
  for (std::size_t g = bends_.size(); g-- > 0;) FollowSpeed(g, numbers);
  Tangents all = other + curvature_ * numbers[Kind::kPosition];
  for (const int dof : law_.law->sliding().inertia().dofs())
    all.row(dof) += numbers[Kind::kState].row(law_.first_state + static_cast<int>(m.nwrap) + dof);
  return all;
}

const Tangents& CableDerivatives::Follow(const mjModel& m, const mjData& d,
                                         const NumberTangents& numbers, const Tangents& other) {
  FollowTensions(m, d, AllTangents(m, d, numbers, other));
  force_ = curvature_ * numbers[Kind::kPosition];
  for (std::size_t g = 0; g < bends_.size(); ++g) {
    const auto row = static_cast<Eigen::Index>(g);
    ForEachArm(g, [&](int dof, double arm) {
      force_.row(dof) -= arm * (tension_.row(row) - base_.row(bends_[g].cable));
    });
  }
  FollowShares();
  for (int c = 0; c < law_.law->geometry().cables(); ++c) {
    if (law_.law->base()[c] == 0) FollowFade(m, d, c, numbers);
  }
  return force_;
}

void CableDerivatives::FollowTurn(const mjModel& m, const mjData& d, const NumberTangents& numbers,
                                  const Tangents& other) {
  const Tangents x = FollowTensions(m, d, AllTangents(m, d, numbers, other));
  const std::vector<double> before(d.qvel, d.qvel + m.nv);
  const auto after = Eigen::VectorXd::Map(after_.data(), std::ssize(after_));
  turned_.setZero(std::ssize(bends_), other.cols());
  for (std::size_t g = 0; g < bends_.size(); ++g) {
    const auto row = static_cast<Eigen::Index>(g);
    if (law_.law->bends()[g].turned == 0) continue;
    const double v = bends_[g].speed, kept = pulled_.col(row).dot(after);
    const RowVector kept_change =
        SpeedChange(g, after_, numbers) + pulled_.col(row).transpose() * x;
    turned_.row(row) =
        (v * kept_change - kept * SpeedChange(g, before, numbers)) / ((v - kept) * (v - kept));
  }
}

template <class Fn>
void CableDerivatives::ForEachArm(std::size_t g, Fn&& fn) const {
  const CableGeometry& route = law_.law->geometry();
  const int s = bends_[g].segment;
  for (int l = route.begin[s]; l < route.begin[s + 1]; ++l) fn(route.dof[l], route.arm[l]);
}

bool CableDerivatives::First(std::size_t g) const {
  return g == 0 || bends_[g - 1].cable != bends_[g].cable;
}

void CableDerivatives::FollowBands(const mjModel& m, const mjData& d,
                                   const NumberTangents& numbers) {
  const CableFriction& law = *law_.law;
  const Tangents& position = numbers[Kind::kPosition];
  band_.setZero(law.geometry().segments(), position.cols());
  memory_ = band_;
  for (int c = 0; c < law.geometry().cables(); ++c) {
    const std::vector<int>& sites = law.cables()[c].sites;
    const int first = law.geometry().first[c];
    for (std::size_t k = 1; k + 1 < sites.size(); ++k)
      FollowBand(first + static_cast<int>(k), AngleTangents(m, d, &sites[k - 1], position),
                 numbers);
  }
}

// The band of the contact in front of a segment, and what it remembers within it.
void CableDerivatives::FollowBand(int s, const RowVector& theta, const NumberTangents& numbers) {
  const CableFriction& law = *law_.law;
  double by_theta = 0;
  std::vector<double> by_parameter(law.parameters().size());
  law.BandSlopes(law.geometry().theta[s], by_theta, by_parameter);
  band_.row(s) = by_theta * theta;
  for (std::size_t i = 0; i < by_parameter.size(); ++i)
    band_.row(s) +=
        by_parameter[i] * numbers[Kind::kParameter].row(law_.first_parameter + static_cast<int>(i));
  const double z = law_.state[s], band = law.band()[s];
  if (std::abs(z) < band) {
    memory_.row(s) = numbers[Kind::kState].row(law_.first_state + s);
  } else {
    memory_.row(s) = (z < 0 ? -1 : 1) * band_.row(s);
  }
}

// Of k x + b L̇ of a tendon, x beyond the range in which its spring rests.
void CableDerivatives::FollowPassive(const mjModel& m, const mjData& d, int t,
                                     const NumberTangents& numbers, Eigen::Ref<RowVector> tension) {
  const double* const rest = m.tendon_lengthspring + 2 * t;
  const double x = BeyondRest(m, t, d.ten_length[t]);
  if (!(m.opt.disableflags & mjDSBL_SPRING) && (x != 0 || rest[0] == rest[1])) {
    tension += x * numbers.tendon_stiffness.row(t) +
               m.tendon_stiffness[t] * (numbers[Kind::kLength].row(t) -
                                        numbers[Kind::kTendonRest].row(2 * t + (x > 0)));
  }
  if (!(m.opt.disableflags & mjDSBL_DAMPER)) {
    tension += d.ten_velocity[t] * numbers.tendon_damping.row(t) +
               m.tendon_damping[t] * numbers[Kind::kRate].row(t);
  }
}

// t_0 = −Σ gear · force, and spring and damper, where that pulls.
void CableDerivatives::FollowBases(const mjModel& m, const mjData& d,
                                   const NumberTangents& numbers) {
  const CableFriction& law = *law_.law;
  base_.setZero(law.geometry().cables(), band_.cols());
  for (int c = 0; c < law.geometry().cables(); ++c) {
    if (law.base()[c] == 0) continue;
    for (const int a : law.cables()[c].actuators) {
      const int output = m.actuator_outadr[a];
      base_.row(c) -= m.actuator_gear[6 * output] * numbers[Kind::kActuator].row(a) +
                      d.actuator_force[output] * numbers[Kind::kGear].row(a);
    }
    FollowPassive(m, d, law.cables()[c].tendon, numbers, base_.row(c));
  }
}

// (2): what the tension behind a bend is to that before it, and how it yields.
void CableDerivatives::FollowRatios(const NumberTangents& numbers) {
  const CableFriction& law = *law_.law;
  const Tangents& state = numbers[Kind::kState];
  ratio_.assign(bends_.size(), 1), yield_.assign(bends_.size(), 0);
  ratio_change_.setZero(std::ssize(bends_), band_.cols()), yield_change_ = ratio_change_;
  double expected = 0;
  RowVector expected_change, level;
  const double give = law.Give();  // v_c = give/h where it acts
  const bool gives = law.sliding().gives();
  RowVector give_change = RowVector::Zero(band_.cols());
  if (gives)
    give_change = numbers[Kind::kParameter].row(law_.first_parameter + law.GiveParameter());
  for (std::size_t g = 0; g < bends_.size(); ++g) {
    const Bend& bend = bends_[g];
    const auto row = static_cast<Eigen::Index>(g);
    const CableFriction::Group& group = law.group(g);
    const int first = law.geometry().first[bend.cable];
    if (First(g)) {
      expected = law.base()[bend.cable], expected_change = base_.row(bend.cable);
      level = RowVector::Zero(band_.cols());
    }
    RowVector band = RowVector::Zero(band_.cols()), memory = band;
    for (int k = group.begin; k < group.end; ++k) {
      band += band_.row(k), memory += memory_.row(k);
      level += state.row(law_.first_state + k);
    }
    const int side = SideOf(bend);
    ratio_[g] = side == 0 ? std::exp(bend.memory) : bend.band > 0 ? bend.ratio : 1;
    ratio_change_.row(row) =
        side == 0 ? RowVector(ratio_[g] * memory) : RowVector(SlidingSlope(bend) * band);
    if (bend.turned > 0)
      ratio_change_.row(row) += (1 / SideRatio(bend) - SideRatio(bend)) * turned_.row(row);
    expected_change = ratio_[g] * expected_change + expected * ratio_change_.row(row);
    expected *= ratio_[g];
    if (side != 0) continue;
    const double last = law_.state[first] * std::exp(bend.level);
    const bool lasts = last > expected;
    const double stiff = lasts ? last : expected;
    const RowVector stiff_change =
        lasts ? RowVector(last * level + std::exp(bend.level) * state.row(law_.first_state + first))
              : expected_change;
    yield_[g] = bend.band * stiff / give_way_;
    yield_change_.row(row) = (band * stiff + bend.band * stiff_change) / give_way_;
    if (gives) yield_change_.row(row) -= yield_[g] / give * give_change;
  }
}

// v_g⁺ = −Σ_{k ≥ g} dL_k/dq (q̇ + x), from the end of each cable on.
void CableDerivatives::FollowSpeed(std::size_t g, const NumberTangents& numbers) {
  const Bend& bend = bends_[g];
  const auto column = static_cast<Eigen::Index>(g);
  if (g + 1 < bends_.size() && bends_[g + 1].cable == bend.cable)
    pulled_.col(column) = pulled_.col(column + 1);
  ForEachArm(g, [&](int dof, double arm) { pulled_(dof, column) -= arm; });
  if (SideOf(bend) != 0) return;
  speed_.row(column) = SpeedChange(g, after_, numbers);
  speed_after_[g] =
      pulled_.col(column).dot(Eigen::VectorXd::Map(after_.data(), std::ssize(after_)));
}

// Of v_g at such speeds of the robot, as its pose and the speeds at the step's start change.
CableDerivatives::RowVector CableDerivatives::SpeedChange(std::size_t g,
                                                          const std::vector<double>& speeds,
                                                          const NumberTangents& numbers) const {
  const Bend& bend = bends_[g];
  const Cable& cable = law_.law->cables()[bend.cable];
  std::vector<double> weight(cable.segments(), 0), bent(speeds.size(), 0);
  std::fill(weight.begin() + Place(bend.segment, bend.cable), weight.end(), -1.0);
  derivatives_.tendons().AddBends(cable.tendon, weight, speeds.data(), bent);
  const auto moved = Eigen::VectorXd::Map(bent.data(), std::ssize(bent));
  return moved.transpose() * numbers[Kind::kPosition] +
         pulled_.col(static_cast<Eigen::Index>(g)).transpose() * numbers[Kind::kSpeed];
}

void CableDerivatives::AddCurvatures(const mjModel& m) {
  const CableFriction& law = *law_.law;
  curvature_.setZero(m.nv, m.nv);
  for (int c = 0; c < law.geometry().cables(); ++c) {
    const Cable& cable = law.cables()[c];
    std::vector<double> weight(cable.segments(), 0);
    for (std::size_t g = 0; g < bends_.size(); ++g) {
      const Bend& bend = bends_[g];
      if (bend.cable == c) weight[Place(bend.segment, c)] = law.base()[c] - TensionOf(g);
    }
    derivatives_.tendons().AddCurvature(cable.tendon, weight, curvature_);
  }
}

// (1) and (2) with dt_g = constant_g + follow_g dx.
// dx, where it matters.
Tangents CableDerivatives::FollowTensions(const mjModel& m, const mjData& d, Tangents other) {
  tension_.setZero(std::ssize(bends_), other.cols());
  Eigen::MatrixXd follow = Eigen::MatrixXd::Zero(std::ssize(bends_), m.nv);
  for (std::size_t g = 0; g < bends_.size(); ++g) {
    const auto row = static_cast<Eigen::Index>(g);
    const bool first = First(g);
    const double before = first ? law_.law->base()[bends_[g].cable] : TensionOf(g - 1);
    tension_.row(row) = before * ratio_change_.row(row) +
                        ratio_[g] * (first ? base_.row(bends_[g].cable) : tension_.row(row - 1)) -
                        speed_after_[g] * yield_change_.row(row) - yield_[g] * speed_.row(row);
    if (!first) follow.row(row) = ratio_[g] * follow.row(row - 1);
    follow.row(row) -= yield_[g] * pulled_.col(row).transpose();
  }
  if (!rests_) return {};
  Eigen::MatrixXd inertia(m.nv, m.nv);
  mj_fullM(&m, &d, inertia.data());
  inertia = inertia / m.opt.timestep - derivatives_.damping();
  for (std::size_t g = 0; g < bends_.size(); ++g) {
    const auto row = static_cast<Eigen::Index>(g);
    ForEachArm(g, [&](int dof, double arm) {
      inertia.row(dof) += arm * follow.row(row);
      other.row(dof) -= arm * (tension_.row(row) - base_.row(bends_[g].cable));
    });
  }
  Tangents x = inertia.partialPivLu().solve(other);
  tension_ += follow * x;
  return x;
}

// ρ of every contact: bends that are several contacts share theirs (CableFriction::Spread).
void CableDerivatives::FollowShares() {
  const CableFriction& law = *law_.law;
  rho_.setZero(band_.rows(), band_.cols());
  for (std::size_t g = 0; g < bends_.size(); ++g) {
    const Bend& bend = bends_[g];
    const auto row = static_cast<Eigen::Index>(g);
    const CableFriction::Group& group = law.group(g);
    if (const int side = SideOf(bend); side != 0) {
      for (int k = group.begin; k < group.end; ++k) rho_.row(k) = side * band_.row(k);
      continue;
    }
    const double before = First(g) ? law.base()[bend.cable] : TensionOf(g - 1);
    const RowVector ahead = First(g) ? base_.row(bend.cable) : tension_.row(row - 1);
    const RowVector all = tension_.row(row) / bend.tension - ahead / before;
    if (group.end == group.begin + 1) {
      rho_.row(group.begin) = all;
      continue;
    }
    const double rho = std::log(bend.ratio), sign = rho < bend.memory ? -1 : 1;
    const double room = bend.band - sign * bend.memory;
    const double part = room > 0 ? std::min(1.0, std::abs(rho - bend.memory) / room) : 0;
    RowVector memory = RowVector::Zero(band_.cols()), band = memory;
    for (int k = group.begin; k < group.end; ++k) memory += memory_.row(k), band += band_.row(k);
    RowVector share = RowVector::Zero(band_.cols());
    if (room > 0 && part < 1)
      share = (sign * (all - memory) - part * (band - sign * memory)) / room;
    for (int k = group.begin; k < group.end; ++k) {
      const double limit = law.band()[k], old = std::clamp(law_.state[k], -limit, limit);
      rho_.row(k) =
          (1 - part) * memory_.row(k) + part * sign * band_.row(k) + (sign * limit - old) * share;
    }
  }
}

// Of −Σ_{k ≥ s} dL_k/dq q̇ at the start of the step.
CableDerivatives::RowVector CableDerivatives::SlipChange(const mjData& d, int c, int s,
                                                         const NumberTangents& numbers) const {
  const CableGeometry& route = law_.law->geometry();
  const Cable& cable = law_.law->cables()[c];
  const Eigen::Index nv = numbers[Kind::kSpeed].rows();
  std::vector<double> weight(cable.segments(), 0), bent(nv, 0);
  std::fill(weight.begin() + Place(s, c), weight.end(), -1.0);
  derivatives_.tendons().AddBends(cable.tendon, weight, d.qvel, bent);
  RowVector change = Eigen::VectorXd::Map(bent.data(), nv).transpose() * numbers[Kind::kPosition];
  for (int l = route.begin[s]; l < route.begin[route.first[c + 1]]; ++l)
    change -= route.arm[l] * numbers[Kind::kSpeed].row(route.dof[l]);
  return change;
}

// What a slack cable remembers after the step, as CableFriction::Fade has it.
void CableDerivatives::FollowFade(const mjModel& m, const mjData& d, int c,
                                  const NumberTangents& numbers) {
  const CableFriction& law = *law_.law;
  const double h = m.opt.timestep, give_way = CableSliding::GiveWay(law.Give(), h);
  for (int s = law.geometry().first[c] + 1; s < law.geometry().first[c + 1]; ++s) {
    const double z = law_.state[s], band = law.band()[s], slip = law.geometry().slip[s];
    rho_.row(s).setZero();
    if (std::abs(z) <= band * std::abs(slip) / give_way) continue;
    RowVector fade = std::abs(slip) * band_.row(s);
    if (slip != 0) fade += (slip < 0 ? -band : band) * SlipChange(d, c, s, numbers);
    if (law.Give() / h == give_way) {
      const auto give = law_.first_parameter + law.GiveParameter();
      fade -= band * std::abs(slip) / law.Give() * numbers[Kind::kParameter].row(give);
    }
    rho_.row(s) =
        numbers[Kind::kState].row(law_.first_state + s) - (z < 0 ? -1 : 1) / give_way * fade;
  }
}

void CableDerivatives::AddNext(const mjModel& m, const Tangents& constraint,
                               NumberTangents& numbers) const {
  const CableFriction& law = *law_.law;
  Tangents& next = numbers[Kind::kNext];
  for (Eigen::Index k = 0; k < rho_.rows(); ++k) next.row(law_.first_state + k) = rho_.row(k);
  for (int c = 0; c < law.geometry().cables(); ++c) {
    const int first = law.geometry().first[c];
    next.row(law_.first_state + first) = base_.row(c);
    if (law.base()[c] == 0)  // a slack cable keeps it
      next.row(law_.first_state + first) = numbers[Kind::kState].row(law_.first_state + first);
  }
  next.middleRows(law_.first_state + static_cast<Eigen::Index>(m.nwrap), m.nv) =
      constraint.topRows(m.nv);
}

}  // namespace continuum
