#include "models/spa/side_force.h"

#include <algorithm>
#include <string>

#include "error.h"
#include "sim/model/model_spec.h"

namespace continuum {
namespace {

double Bend(const ModelAndData& machine, int node) {
  const std::string name = "bend" + std::to_string(node) + "_y";
  const int joint = mj_name2id(machine.model.get(), mjOBJ_JOINT, name.c_str());
  return machine.data->qpos[machine.model->jnt_qposadr[joint]];
}

}  // namespace

SpaSideForce PushAcross(const SpaFile& file, const SpaLayout& layout, double force) {
  constexpr double kSettled = 20;  // [s]: bending dies away as exp(−1.9 t/s)
  const int n = layout.links;
  const ModelAndData machine = ModelSpec::Parse(SpaMjcf(file, layout)).Build();
  mjModel& m = *machine.model;
  mjData& d = *machine.data;
  std::fill_n(m.opt.gravity, 3, 0.0);
  const int tip = mj_name2id(&m, mjOBJ_BODY, ("link" + std::to_string(n)).c_str());
  d.xfrc_applied[6 * tip] = force;
  for (double t = 0; t < kSettled; t += m.opt.timestep) mj_step(&m, &d);
  // What diverges starts anew, and cannot be told from rest.
  if (d.warning[mjWARN_BADQACC].number > 0) {
    throw Error::Job("soft actuator: the chain diverged under a side force");
  }

  const SpaParameters<double>& p = file.parameters;
  const double unit = force * p.L0 * p.L0 / (p.k_theta * p.d * p.d);
  double sum = 0;
  for (int k = 0; k <= n; ++k) sum += Bend(machine, k);
  const double half = sum / (2 * n);  // an even share at either end
  return {d.xpos[3 * tip] / unit, 0.25 + (1.0 / 12 + 1.0 / (6.0 * n * n)) / layout.evenness,
          Bend(machine, 0) / half, Bend(machine, n) / half};
}

}  // namespace continuum
