#include "identification/inverse_dynamics/log_motion.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "error.h"
#include "identification/inverse_dynamics/pose_positions.h"
#include "identification/inverse_dynamics/stationary_rows.h"
#include "identification/inverse_dynamics/zero_phase_lowpass.h"
#include "sim/experiment/measurement_model.h"
#include "sim/model/joint_equalities.h"
#include "sim/model/mujoco_handles.h"
#include "sim/simulation/wiring.h"

namespace continuum {
namespace {

using Source = Wiring::Source;

constexpr double kFilter = 50;        // Hz
constexpr double kOfTheRate = 0.2;    // of the sampling rate, at most
constexpr double kSpeedNoise = 4e-3;  // of a joint's fastest, at least: filters ring after stops

double EvenStep(const Log& log) {
  const double step = (log.time.back() - log.time.front()) / static_cast<double>(log.rows() - 1);
  for (std::size_t k = 1; k < log.rows(); ++k) {
    if (std::abs(log.time[k] - log.time[k - 1] - step) > 0.01 * step) {
      throw Error::Input("--method regressor", log.label + " sampled evenly",
                         fmt::format("{:g} s after {:g} s, {:g} s on average",
                                     log.time[k] - log.time[k - 1], log.time[k - 1], step));
    }
  }
  return step;
}

// Reads the channels of one log, by what they measure.
class LogReader {
 public:
  LogReader(const Problem& problem, const mjModel& m, LogMotion& motion)
      : problem_(problem),
        e_(problem.experiment()),
        log_(e_.logs[motion.log]),
        m_(m),
        ties_(m),
        wiring_(e_, m),
        motion_(motion) {
    motion.prescribed.assign(ties_.dofs().size(), false);
  }

  void Read() {
    for (std::size_t c = 0; c < e_.channels.size(); ++c) ReadChannel(c);
    motion_.wrench = std::move(forces_.empty() ? torques_ : forces_);
  }

  const JointEqualities& ties() const { return ties_; }
  std::vector<MeasuredPlace> places;  ///< low-passed
  std::vector<double> noise;          ///< [place] of the speed of a joint

 private:
  void ReadChannel(std::size_t c) {
    const Source& source = wiring_.output[e_.channels[c].output];
    if (source.kind == Output::Kind::kForce) {
      motion_.actuator_force.emplace_back(source.address, Measured(c));
    } else if (source.kind == Output::Kind::kSensor) {
      ReadSensor(c, source);
    }
  }

  void ReadSensor(std::size_t c, const Source& source) {
    const int s = source.sensor;
    switch (m_.sensor_type[s]) {
      case mjSENS_JOINTPOS:
        return ReadJoint(c, s);
      case mjSENS_FRAMEPOS:
        if (m_.sensor_refid[s] >= 0) return;
        return places.push_back(
            {MeasuredPlace::Kind::kPoint, s, source.component, UnitOf(c), {Smooth(Measured(c))}});
      case mjSENS_FRAMEQUAT:
        if (m_.sensor_refid[s] < 0 && e_.channels[c].component == 0) ReadTurn(c, s);
        return;
      case mjSENS_FORCE:
        return ReadWrench(c, source, forces_);
      case mjSENS_TORQUE:
        return ReadWrench(c, source, torques_);
      default:
        return;
    }
  }

  void ReadJoint(std::size_t c, int sensor) {
    const auto& dofs = ties_.dofs();
    const auto at = std::find(dofs.begin(), dofs.end(), m_.jnt_dofadr[m_.sensor_objid[sensor]]);
    if (at == dofs.end()) return;
    motion_.prescribed[at - dofs.begin()] = Drives(e_.channels[c].name, m_.sensor_objid[sensor]);
    const std::vector<double> y = Measured(c);
    places.push_back({MeasuredPlace::Kind::kJoint,
                      static_cast<int>(at - dofs.begin()),
                      0,
                      UnitOf(c),
                      {Smooth(y)}});
    noise.resize(places.size());
    noise.back() = SpeedNoise(y, places.back().value[0], motion_.cutoff, motion_.step);
  }

  bool Drives(const std::string& column, int joint) const {
    for (std::size_t i = 0; i < e_.inputs.size(); ++i) {
      const int a = wiring_.actuator[i];
      if (e_.inputs[i].column == column && m_.actuator_trntype[a] == mjTRN_JOINT &&
          m_.actuator_trnid[2 * a] == joint)
        return true;
    }
    return false;
  }

  void ReadWrench(std::size_t c, const Source& source, std::vector<MeasuredWrench>& to) {
    if (Counts(c))
      to.push_back({source.address + source.component, UnitOf(c), Smooth(Measured(c))});
  }

  // A quaternion and its opposite are one orientation.
  void ReadTurn(std::size_t c, int sensor) {
    MeasuredPlace place{MeasuredPlace::Kind::kTurn, sensor, 0, UnitOf(c), {}};
    for (std::size_t i = 0; i < 4; ++i) place.value.push_back(Measured(c + i));
    auto& y = place.value;
    for (std::size_t k = 1; k < log_.rows(); ++k) {
      double along = 0;
      for (int i = 0; i < 4; ++i) along += y[i][k - 1] * y[i][k];
      for (int i = 0; i < 4 && along < 0; ++i) y[i][k] = -y[i][k];
    }
    for (auto& component : y) component = Smooth(component);
    places.push_back(std::move(place));
  }

  std::vector<double> Measured(std::size_t c) const {
    std::vector<double> y = SignalsOf(e_, log_, c);
    for (std::size_t k = 0; k < y.size(); ++k) {
      if (!std::isnan(y[k])) continue;
      throw Error::Input("--method regressor",
                         "channel '" + e_.channels[c].name + "' measured at every row",
                         fmt::format("a gap at {:g} s of {}", log_.time[k], log_.label));
    }
    return y;
  }
  std::vector<double> Smooth(const std::vector<double>& y) const {
    return LowPass(y, motion_.cutoff);
  }

  bool Counts(std::size_t c) const {
    const auto& counted = problem_.channels();
    return std::find(counted.begin(), counted.end(), c) != counted.end();
  }
  double UnitOf(std::size_t c) const {
    const auto& counted = problem_.channels();
    const auto at = std::find(counted.begin(), counted.end(), c);
    return at == counted.end() ? 1 : problem_.scale(at - counted.begin());
  }
  const Problem& problem_;
  const Experiment& e_;
  const Log& log_;
  const mjModel& m_;
  JointEqualities ties_;
  Wiring wiring_;
  LogMotion& motion_;
  std::vector<MeasuredWrench> forces_, torques_;
};

// In the world's frame and clock alone do places say what the model has.
void RequireNoRegistration(const Experiment& e) {
  const Registration& r = e.registration;
  if (r.has_frame() || r.has_marker() || r.has_clock())
    throw Error::Input("--method regressor", "places in the world's frame and clock",
                       "an experiment with registration");
}

// Of joints that are all measured; else an empty list, and which is not.
std::vector<std::vector<double>> MeasuredJoints(const LogReader& read, const mjModel& m,
                                                std::string& lacks) {
  const auto& dofs = read.ties().dofs();
  std::vector<std::vector<double>> q(dofs.size());
  for (const MeasuredPlace& place : read.places)
    if (place.kind == MeasuredPlace::Kind::kJoint) q[place.at] = place.value[0];
  for (std::size_t i = 0; i < dofs.size(); ++i) {
    if (!q[i].empty()) continue;
    lacks = "no output of joint " + Called(m, mjOBJ_JOINT, m.dof_jntid[dofs[i]]);
    return {};
  }
  return q;
}

std::vector<std::vector<double>> Positions(const LogReader& read, const Experiment& e,
                                           ModelAndData& machine, LogMotion& motion) {
  std::string lacks;
  auto q = MeasuredJoints(read, *machine.model, lacks);
  if (lacks.empty()) return q;
  const bool joints = std::all_of(read.places.begin(), read.places.end(), [](const auto& place) {
    return place.kind == MeasuredPlace::Kind::kJoint;
  });
  if (joints)
    throw Error::Input("--method regressor", "every joint measured, or places that follow them",
                       lacks);
  RequireNoRegistration(e);
  motion.from_places = true;
  return PositionsFromPlaces(read.places, read.ties(), machine, e.logs[motion.log].label);
}

void Differentiate(const LogReader& read, LogMotion& motion) {
  motion.noise.assign(motion.q.size(), 0);
  for (std::size_t p = 0; p < read.noise.size(); ++p) {
    if (read.places[p].kind == MeasuredPlace::Kind::kJoint)
      motion.noise[read.places[p].at] = read.noise[p];
  }
  for (std::size_t i = 0; i < motion.q.size(); ++i) {
    motion.v.push_back(Derivative(motion.q[i], motion.step));
    motion.a.push_back(Derivative(motion.v[i], motion.step));
    double fastest = 0;
    for (const double v : motion.v[i]) fastest = std::max(fastest, std::abs(v));
    motion.noise[i] = std::max(motion.noise[i], kSpeedNoise * fastest);
  }
}

}  // namespace

LogMotion MotionOf(const Problem& problem, ModelAndData& machine, std::size_t index,
                   double cutoff) {
  const Log& log = problem.experiment().logs[index];
  LogMotion motion{index, EvenStep(log), 0, {}, {}, {}, {}, {}, {}, {}, false};
  const double rate = 1 / motion.step;
  motion.cutoff = std::min(cutoff > 0 ? cutoff : kFilter, kOfTheRate * rate) / rate;
  LogReader read(problem, *machine.model, motion);
  read.Read();
  motion.q = Positions(read, problem.experiment(), machine, motion);
  Differentiate(read, motion);
  return motion;
}

}  // namespace continuum
