#include "models/spa/experiment.h"

#include <Eigen/LU>

#include "sim/numerics/portable_random.h"

namespace continuum {
namespace {

using Eigen::Vector3d;
using Vector6 = Eigen::Matrix<double, 6, 1>;

template <int N>
using Series = std::vector<Eigen::Matrix<double, N, 1>>;

template <int N, class Fn>
Series<N> PerChannel(const Series<N>& series, Fn&& fn) {
  Series<N> result(series.size());
  std::vector<double> channel(series.size());
  for (int i = 0; i < N; ++i) {
    for (std::size_t k = 0; k < series.size(); ++k) channel[k] = series[k][i];
    const std::vector<double> changed = fn(channel);
    for (std::size_t k = 0; k < series.size(); ++k) result[k][i] = changed[k];
  }
  return result;
}

template <int N>
Series<N> Filtered(const Series<N>& series, const SpaFilter& filter, double period) {
  return PerChannel<N>(series, [&](const auto& x) { return filter(x, period); });
}

Series<3> Rate(const Series<3>& series, double period) {
  return PerChannel<3>(series, [&](const auto& x) { return Differentiate(x, period); });
}

}  // namespace

SpaRecording SpaRecordStep(const Spa<double>& spa, const Vector3d& pressure, const SpaNoise& noise,
                           unsigned seed) {
  const double period = 1e-3;
  std::vector<Vector3d> input(1200, pressure);
  std::fill_n(input.begin(), 200, Vector3d::Zero());
  const SpaBase<double> base = SpaBase<double>::Hanging();
  const auto samples = SpaRespond(spa, SpaAtRest(spa, Vector3d::Zero(), base), input, period,
                                  [&](double) { return base; });
  Random32 random(seed);
  const auto draw = [&] {
    Vector3d noise;
    for (const int i : {2, 1, 0})
      noise[i] = random.Normal();  // published numbers hang on the order
    return noise;
  };
  SpaRecording recording{period, {}, {}, {}};
  for (std::size_t k = 0; k < samples.size(); ++k) {
    recording.pressure.push_back(input[k] + noise.pressure * draw());
    recording.tip.push_back(samples[k].tip + noise.tip * draw());
    Vector6 wrench = samples[k].wrench;
    wrench.head<3>() += noise.force * draw();
    wrench.tail<3>() += noise.torque * draw();
    recording.wrench.push_back(wrench);
  }
  return recording;
}

SpaMotion SpaRegain(const PccSegment<double>& segment, const SpaRecording& recording,
                    const SpaFilter& filter) {
  const double period = recording.period;
  const Series<3> tip = Filtered<3>(recording.tip, filter, period);
  const Series<3> velocity = Filtered<3>(Rate(tip, period), filter, period);
  const Series<3> acceleration = Rate(velocity, period);
  const Series<6> wrench = Filtered<6>(recording.wrench, filter, period);
  SpaMotion motion;
  for (std::size_t k = kSpaTrim; k + kSpaTrim < tip.size(); ++k) {
    const Vec<double, 3> delta = PccFromTip(segment, {tip[k][0], tip[k][1], tip[k][2]});
    const auto matrix = [](const Mat3<double>& m) {
      return Eigen::Matrix3d(
          Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(m[0].data()));
    };
    const auto still = PccCentreLine(segment, 1.0, delta, Vec<double, 3>{});
    const Eigen::Matrix3d inverse = matrix(still.jacobian).inverse();
    const Vector3d rate = inverse * velocity[k];
    const auto moving = PccCentreLine(segment, 1.0, delta, {rate[0], rate[1], rate[2]});
    motion.state.push_back({{delta[0], delta[1], delta[2]}, rate});
    motion.acceleration.push_back(inverse *
                                  (acceleration[k] - matrix(moving.jacobian_rate) * rate));
    motion.wrench.push_back(wrench[k]);
  }
  return motion;
}

std::vector<Vector3d> SpaChamberPressure(const SpaRecording& recording, double lag,
                                         const SpaFilter& filter) {
  Series<3> chamber{recording.pressure[0]};
  for (std::size_t k = 0; k + 1 < recording.pressure.size(); ++k) {
    Vector3d next;
    for (int i = 0; i < 3; ++i) {
      next[i] = SpaLag(chamber[k][i], recording.pressure[k][i], recording.period, lag);
    }
    chamber.push_back(next);
  }
  const Series<3> smooth = Filtered<3>(chamber, filter, recording.period);
  return {smooth.begin() + kSpaTrim, smooth.end() - kSpaTrim};
}

}  // namespace continuum
