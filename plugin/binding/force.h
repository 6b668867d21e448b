#pragma once

#include <algorithm>
#include <string>

#include "binding/bound_law.h"

namespace continuum {

/// By how much a length lies beyond the range in which a tendon's spring rests.
inline double BeyondRest(const mjModel& m, int tendon, double length) {
  const double* const rest = m.tendon_lengthspring + 2 * tendon;
  return length - std::clamp(length, rest[0], rest[1]);
}

/// A joint of one degree of freedom or a tendon, as a port of a Force law.
struct Line {
  bool joint;
  int id, dof;

  /// x is counted from the rest position of the native spring: a joint's springref, the nearest end
  /// of a tendon's springlength.
  Port<double> At(const mjModel& m, const mjData& d) const {
    if (!joint) return {BeyondRest(m, id, d.ten_length[id]), d.ten_velocity[id]};
    const int adr = m.jnt_qposadr[id];
    return {d.qpos[adr] - m.qpos_spring[adr], d.qvel[dof]};
  }
  /// The same where a step ends, as MuJoCo has it then: a tendon is still where it began.
  Port<double> After(const mjModel& m, const mjData& d, const StepTaken& step) const {
    if (!joint) return At(m, d);
    const int adr = m.jnt_qposadr[id];
    return {step.qpos[adr] - m.qpos_spring[adr], step.qvel[dof]};
  }
  /// The same as functions of the numbers of Numbers().
  template <std::size_t N>
  Port<Dual<N>> DualAt(const mjModel& m, const mjData& d) const {
    const Port<double> at = At(m, d);
    Port<Dual<N>> dual{{at.x, 0}, {at.v, 2}};
    const double* const rest = m.tendon_lengthspring + 2 * id;
    if (!joint && at.x == 0 && rest[0] != rest[1]) dual.x.d[0] = 0;
    dual.x.d[1] = -dual.x.d[0];
    return dual;
  }
  /// Position, rest and speed, where a step begins.
  std::array<Number, 3> Numbers(const Port<double>& at) const {
    using Kind = Number::Kind;
    if (joint) return {{{Kind::kPosition, dof}, {Kind::kSpringRest, dof}, {Kind::kSpeed, dof}}};
    return {{{Kind::kLength, id}, {Kind::kTendonRest, 2 * id + (at.x > 0)}, {Kind::kRate, id}}};
  }
  void Add(const mjModel& m, const mjData& d, double f, std::span<double> force) const {
    if (joint) {
      force[dof] += f;
      return;
    }
    const int adr = m.ten_J_rowadr[id];
    for (int k = adr; k < adr + m.ten_J_rownnz[id]; ++k) force[m.ten_J_colind[k]] += d.ten_J[k] * f;
  }
};

/// The joints or tendons named in config.
std::vector<Line> LinesOf(const mjModel& m, const Config& config, Joints types);

/// A Force law on joints or tendons: −F(x, v, z) along each.
template <ForceLaw E>
class BoundForce : public BoundLaw {
 public:
  static constexpr int kZ = static_cast<int>(E::kStates.size());

  BoundForce(const mjModel& m, const Config& config)
      : BoundLaw(ReadParams<E>(config)), lines_(LinesOf(m, config, JointsOf<E>())) {}

  static int StateSize(const mjModel& m, const Config& config) {
    return kZ * static_cast<int>(LinesOf(m, config, JointsOf<E>()).size());
  }

  bool GivesForce() const override { return true; }

  bool Evaluate(const mjModel& m, mjData& d, const double* z, Stage stage,
                std::span<double> force) override {
    if (stage != Stage::kPassive) return false;
    std::fill(force.begin(), force.end(), 0.0);
    const auto p = AsParams<E>(p_);
    for (const Line& line : lines_) {
      line.Add(m, d, -E::template Eval<double>(line.At(m, d), Load(z), p).force, force);
      z += kZ;
    }
    return true;
  }

  void Advance(const mjModel& m, const mjData& d, double* z) override {
    const auto p = AsParams<E>(p_);
    for (const Line& line : lines_) {
      const auto next = E::template Step<double>(Load(z), line.At(m, d), m.opt.timestep, p);
      z = std::copy(next.begin(), next.end(), z);
    }
  }

  std::string WhyIdle(const mjModel& m) const override {
    if constexpr (requires(Vec<double, kParamCount<E>> p) { E::LeastDamping(p); }) {
      const double least = E::LeastDamping(AsParams<E>(p_));
      for (const Line& line : lines_) {
        if (least > m.dof_damping[line.dof])
          return "creates energy at joint '" + std::string(mj_id2name(&m, mjOBJ_JOINT, line.id)) +
                 "', as d is more than b and the joint's damping together";
      }
    }
    return "";
  }

  std::string WhyNoSlopes(const mjModel&) const override { return ""; }

  void Differentiate(const mjModel& m, const mjData& d, const StepTaken& step,
                     LawSlopes& slopes) const override {
    int state = 0;
    for (const Line& line : lines_) {
      DifferentiateForce(m, d, line, step.z + state, state, slopes);
      DifferentiateStep(m, d, line, step, state, slopes);
      state += kZ;
    }
  }

  bool Rates(const mjModel& m, const mjData& d, const double* z, double* rate) const override {
    const auto p = AsParams<E>(p_);
    for (const Line& line : lines_) {
      const auto zdot = E::template Eval<double>(line.At(m, d), Load(z), p).zdot;
      rate = std::copy(zdot.begin(), zdot.end(), rate);
      z += kZ;
    }
    return true;
  }

 private:
  // Position, rest, speed; states; parameters.
  static constexpr std::size_t kN = 3 + kZ + kParamCount<E>;
  using T = Dual<kN>;

  static std::array<Number, kN> NumbersOf(const std::array<Number, 3>& port, int state) {
    std::array<Number, kN> numbers;
    std::copy(port.begin(), port.end(), numbers.begin());
    for (int i = 0; i < kZ; ++i) numbers[3 + i] = {Number::Kind::kState, state + i};
    for (std::size_t i = 3 + kZ; i < kN; ++i)
      numbers[i] = {Number::Kind::kParameter, static_cast<int>(i) - 3 - kZ};
    return numbers;
  }
  static Vec<T, kZ> DualLoad(const double* z) {
    Vec<T, kZ> state;
    for (int i = 0; i < kZ; ++i) state[i] = T(z[i], 3 + i);
    return state;
  }

  void DifferentiateForce(const mjModel& m, const mjData& d, const Line& line, const double* z,
                          int state, LawSlopes& slopes) const {
    const auto p = DualParams<kN>(AsParams<E>(p_), 3 + kZ);
    const T force = E::template Eval<T>(line.DualAt<kN>(m, d), DualLoad(z), p).force;
    const auto by = NumbersOf(line.Numbers(line.At(m, d)), state);
    const Number of =
        line.joint ? Number{Number::Kind::kForce, line.dof} : Number{Number::Kind::kPull, line.id};
    Put(slopes.forces, of, force, by, -1);
    if (!line.joint) slopes.pulls.push_back({line.id, -force.a});
  }

  void DifferentiateStep(const mjModel& m, const mjData& d, const Line& line, const StepTaken& step,
                         int state, LawSlopes& slopes) const {
    if constexpr (kZ > 0) {
      const auto p = DualParams<kN>(AsParams<E>(p_), 3 + kZ);
      Port<T> port = line.DualAt<kN>(m, d);
      const Port<double> after = line.After(m, d, step);
      port.x.a = after.x, port.v.a = after.v;
      auto by = NumbersOf(line.Numbers(after), state);
      if (line.joint) {
        by[0].kind = Number::Kind::kPositionAfter, by[2].kind = Number::Kind::kSpeedAfter;
      }
      const auto next = E::template Step<T>(DualLoad(step.z + state), port, m.opt.timestep, p);
      for (int i = 0; i < kZ; ++i) Put(slopes.next, {Number::Kind::kNext, state + i}, next[i], by);
    }
  }

  static Vec<double, kZ> Load(const double* z) {
    Vec<double, kZ> state;
    std::copy_n(z, kZ, state.begin());
    return state;
  }

  std::vector<Line> lines_;
};

}  // namespace continuum
