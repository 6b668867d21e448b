#include "models/spa/chain_error.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "error.h"
#include "sim/io/decimal.h"
#include "sim/model/model_spec.h"

namespace continuum {
namespace {

using Eigen::Vector3d;
using Vector6 = Eigen::Matrix<double, 6, 1>;

constexpr double kPeriod = 1e-3, kBegin = 20e-3;  // of inputs and samples; of the step [s]

double SwingSize(int i) { return i < 3 ? 0.02 : 0.2; }
double SwingRate(int i) { return 2 * M_PI * (1 + 0.6 * i); }

// Joints that swing the base by themselves: springs between the world and an armature that nothing
// else moves. Their axes are the world's, seen from the base, which hangs.
std::string Swinging(std::string xml) {
  constexpr double kArmature = 1e6;
  const char* const axes[] = {"1 0 0", "0 -1 0", "0 0 -1", "1 0 0", "0 1 0", "0 0 1"};
  std::string text =
      "\n      <inertial pos=\"0 0 0\" mass=\"1e-9\" diaginertia=\"1e-12 1e-12 1e-12\"/>";
  for (int i = 0; i < 6; ++i) {
    text += fmt::format(
        "\n      <joint name=\"swing{}\" type=\"{}\" axis=\"{}\" armature=\"{}\" "
        "stiffness=\"{}\"/>",
        i, i < 3 ? "slide" : "hinge", axes[i], kArmature,
        Decimal(kArmature * SwingRate(i) * SwingRate(i)));
  }
  xml.insert(xml.find('>', xml.find("<body name=\"base\"")) + 1, text);
  return xml;
}

ModelAndData Build(const SpaFile& file, const SpaStepResponse& trial) {
  const std::string xml = SpaMjcf(file, {.links = trial.links, .evenness = trial.evenness});
  ModelAndData machine = ModelSpec::Parse(trial.moving ? Swinging(xml) : xml).Build();
  mjModel& m = *machine.model;
  m.opt.timestep = trial.timestep;
  m.opt.tolerance = 0;  // it is scaled by the mean inertia, which the base's armature spoils
  if (trial.rk4) {
    // It integrates the lag itself; "filterexact" would then lag by another half step.
    m.opt.integrator = mjINT_RK4;
    std::replace(m.actuator_dyntype, m.actuator_dyntype + m.nu, int{mjDYN_FILTEREXACT},
                 int{mjDYN_FILTER});
  }
  for (int i = 0; trial.moving && i < 6; ++i) {
    const int joint = mj_name2id(&m, mjOBJ_JOINT, fmt::format("swing{}", i).c_str());
    machine.data->qvel[m.jnt_dofadr[joint]] = SwingSize(i) * SwingRate(i);
  }
  return machine;
}

Vector3d Sensor(const ModelAndData& machine, const std::string& name) {
  const mjModel& m = *machine.model;
  const int id = mj_name2id(&m, mjOBJ_SENSOR, name.c_str());
  return Eigen::Map<const Vector3d>(machine.data->sensordata + m.sensor_adr[id]);
}

Vector3d TipInBase(const ModelAndData& machine) {
  using Rows = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  const int base = mj_name2id(machine.model.get(), mjOBJ_BODY, "base");
  const Eigen::Map<const Vector3d> origin(machine.data->xpos + 3 * base);
  const Eigen::Map<const Rows> axes(machine.data->xmat + 9 * base);
  return axes.transpose() * (Sensor(machine, "tip_pos") - origin);
}

// One quantity over a trial: the analytic extremes and the largest distance.
struct Distance {
  double largest = 0;
  Vector3d low = Vector3d::Constant(1e300), high = -low;

  void Add(const Vector3d& chain, const Vector3d& truth) {
    largest = std::max(largest, (chain - truth).norm());
    low = low.cwiseMin(truth);
    high = high.cwiseMax(truth);
  }
  double Share() const { return largest / (high - low).maxCoeff(); }
};

void StepTo(const ModelAndData& machine, double time) {
  const mjData& d = *machine.data;
  while (d.time < time - 1e-9) {
    mj_step(machine.model.get(), machine.data.get());
    // MuJoCo then starts anew at time zero.
    const bool bad = d.warning[mjWARN_BADQACC].number > 0 || d.warning[mjWARN_BADQPOS].number > 0 ||
                     d.warning[mjWARN_BADQVEL].number > 0;
    if (bad)
      throw Error::Job(fmt::format("soft actuator: the chain diverged before {:.4g} s", time));
  }
}

}  // namespace

SpaBaseMotion SpaSwing() {
  return [](double t) {
    Vector6 q, rate, acceleration;
    for (int i = 0; i < 6; ++i) {
      const double size = SwingSize(i), w = SwingRate(i);
      q[i] = size * std::sin(w * t);
      rate[i] = size * w * std::cos(w * t);
      acceleration[i] = -w * w * q[i];
    }
    q[3] += M_PI;
    return SpaCardan<double>::Base(q, rate, acceleration);
  };
}

SpaGap ChainError(const SpaFile& file, const SpaStepResponse& trial) {
  SpaOptions options = file.options;
  options.mass = SpaMass::kArc;
  const Spa<double> spa(file.parameters, options);
  const auto rows = static_cast<std::size_t>(std::lround(trial.duration / kPeriod)) + 1;
  std::vector<Vector3d> input(rows, trial.pressure);
  std::fill_n(input.begin(), std::lround(kBegin / kPeriod), Vector3d::Zero());
  const auto truth = SpaRespond(
      spa, {}, input, kPeriod,
      trial.moving ? SpaSwing() : [](double) { return SpaBase<double>::Hanging(); });

  const ModelAndData machine = Build(file, trial);
  Distance delta, tip, force, torque;
  for (std::size_t k = 0; k < rows; ++k) {
    StepTo(machine, truth[k].time);
    if (std::abs(machine.data->time - truth[k].time) > 1e-9) continue;  // steps of two rows
    Eigen::Map<Vector3d>(machine.data->ctrl) = input[k];
    mj_forward(machine.model.get(), machine.data.get());
    delta.Add(Sensor(machine, "delta"), truth[k].delta);
    tip.Add(TipInBase(machine), truth[k].tip);
    force.Add(Sensor(machine, "base_force"), truth[k].wrench.head<3>());
    torque.Add(Sensor(machine, "base_torque"), truth[k].wrench.tail<3>());
  }
  return {delta.Share(), tip.Share(), force.Share(), torque.Share()};
}

}  // namespace continuum
