#include "identification/sensitivity/sensor_derivatives.h"

#include <algorithm>

#include "sim/model/mujoco_handles.h"
#include "sim/model/object_frame.h"
#include "sim/model/point_jacobian.h"
#include "sim/simulation/wiring.h"

namespace continuum {
namespace {

using Vector3 = Eigen::Vector3d;

bool IsLine(const mjModel& m, int joint) {
  return m.jnt_type[joint] == mjJNT_HINGE || m.jnt_type[joint] == mjJNT_SLIDE;
}

bool HasPast(const mjModel& m, int s) {
  return m.sensor_delay[s] > 0 || m.sensor_interval[2 * s] > 0;
}

bool Covers(const mjModel& m, int s) {
  if (m.sensor_cutoff[s] > 0) return false;
  switch (m.sensor_type[s]) {
    case mjSENS_JOINTPOS:
    case mjSENS_JOINTVEL:
      return IsLine(m, m.sensor_objid[s]);
    case mjSENS_FRAMEPOS:
      return m.sensor_refid[s] < 0;
    default:
      return false;
  }
}

}  // namespace

std::string SensorDerivatives::Obstacle(const mjModel& m, const Wiring& wiring) {
  for (const auto& source : wiring.output) {
    if (source.kind == Output::Kind::kSensor && HasPast(m, source.sensor))
      return "sensor " + Called(m, mjOBJ_SENSOR, source.sensor);
  }
  return "";
}

bool SensorDerivatives::Cover(const mjModel& m, const Wiring& wiring) {
  return !wiring.marked &&
         std::all_of(wiring.output.begin(), wiring.output.end(), [&](const auto& source) {
           return source.kind == Output::Kind::kSensor && Covers(m, source.sensor);
         });
}

SensorDerivatives::SensorDerivatives(const mjModel& m, const Wiring& wiring) : was_(m.nsensordata) {
  for (const auto& source : wiring.output) {
    const int s = source.sensor;
    if (source.kind != Output::Kind::kSensor || !Covers(m, s)) continue;
    const auto known = [&](const Read& read) { return read.sensor == s; };
    if (std::any_of(reads_.begin(), reads_.end(), known)) continue;
    const bool frame = m.sensor_type[s] == mjSENS_FRAMEPOS;
    reads_.push_back({s, m.sensor_adr[s], m.sensor_dim[s],
                      frame ? -1 : m.jnt_dofadr[m.sensor_objid[s]],
                      m.sensor_type[s] == mjSENS_JOINTVEL});
    jacobian_.emplace_back(3, frame ? m.nv : 0);
  }
}

void SensorDerivatives::Update(const mjModel& m, const mjData& d) {
  for (std::size_t r = 0; r < reads_.size(); ++r) {
    if (reads_[r].dof >= 0) continue;
    const int s = reads_[r].sensor, type = m.sensor_objtype[s], id = m.sensor_objid[s];
    const Vector3 point(FrameOf(d, type, id).position);
    jacobian_[r].setZero();
    for (int i = LastDof(m, BodyOf(m, type, id)); i >= 0; i = m.dof_parentid[i])
      jacobian_[r].col(i) = PointJacobian(m, d, i, point);
  }
}

void SensorDerivatives::Move(mjData& d, const double* dq, const double* dv) {
  for (std::size_t r = 0; r < reads_.size(); ++r) {
    const Read& read = reads_[r];
    std::copy_n(d.sensordata + read.address, read.size, &was_[read.address]);
    if (read.dof >= 0) {
      d.sensordata[read.address] += read.speed ? dv[read.dof] : dq[read.dof];
    } else {
      Eigen::Map<Vector3>(d.sensordata + read.address) +=
          jacobian_[r] * Eigen::Map<const Eigen::VectorXd>(dq, jacobian_[r].cols());
    }
  }
}

void SensorDerivatives::MoveFrames(const mjModel& m, mjData& d, const mjData& there) const {
  for (const Read& read : reads_) {
    if (read.dof >= 0) continue;
    const int type = m.sensor_objtype[read.sensor], id = m.sensor_objid[read.sensor];
    Eigen::Map<Vector3>(d.sensordata + read.address) +=
        Vector3(FrameOf(there, type, id).position) - Vector3(FrameOf(d, type, id).position);
  }
}

void SensorDerivatives::Back(mjData& d) const {
  for (const Read& read : reads_)
    std::copy_n(&was_[read.address], read.size, d.sensordata + read.address);
}

}  // namespace continuum
