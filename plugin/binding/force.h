#pragma once

#include <algorithm>

#include "binding/bound_law.h"

namespace continuum {

/// A joint of one degree of freedom or a tendon, as a port of a Force law.
struct Line {
  bool joint;
  int id, dof;

  /// x is counted from the rest position of the native spring: a joint's springref, the nearest end
  /// of a tendon's springlength.
  Port<double> At(const mjModel& m, const mjData& d) const {
    if (!joint) {
      const double* const rest = m.tendon_lengthspring + 2 * id;
      const double length = d.ten_length[id];
      return {length - std::clamp(length, rest[0], rest[1]), d.ten_velocity[id]};
    }
    const int adr = m.jnt_qposadr[id];
    return {d.qpos[adr] - m.qpos_spring[adr], d.qvel[dof]};
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
  static Vec<double, kZ> Load(const double* z) {
    Vec<double, kZ> state;
    std::copy_n(z, kZ, state.begin());
    return state;
  }

  std::vector<Line> lines_;
};

}  // namespace continuum
