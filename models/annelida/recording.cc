#include "models/annelida/recording.h"

#include <cmath>

#include <fmt/format.h>

#include "error.h"
#include "sim/numerics/portable_random.h"

namespace continuum {
namespace {

std::string Header(bool rates) {
  std::string header = "time,cable1,cable2,cable3,cable4";
  for (int i = 1; i <= kAnnelidaLinks; ++i) header += fmt::format(",bend{}_y", i);
  for (int i = 1; rates && i <= kAnnelidaLinks; ++i) header += fmt::format(",rate{}", i);
  return header + ",tip_x,tip_z\n";
}

// At the rows of a trial.
std::vector<PlanarState> Motion(const PlanarChain& chain, double stop, const Recorded& recorded) {
  const long steps = std::lround(kRecordPeriod / recorded.step);
  std::vector<PlanarState> rows;
  PlanarState state;
  for (int row = 0; row < recorded.rows; ++row) {
    rows.push_back(state);
    if (state.q.cwiseAbs().maxCoeff() > stop)
      throw Error::Job("annelida: trial " + recorded.trial + " reaches a stop");
    const auto tension = recorded.tension(row * kRecordPeriod);
    for (long k = 0; k < steps; ++k) chain.Step(state, tension, recorded.step);
  }
  return rows;
}

std::string Csv(const PlanarChain& chain, const Recorded& recorded,
                const std::vector<PlanarState>& motion, std::uint64_t seed) {
  Random random(seed);
  const auto noise = [&](double sigma) { return sigma * random.Normal(); };
  std::string csv = Header(recorded.rates);
  for (int row = 0; row < recorded.rows; ++row) {
    const PlanarState& state = motion[row];
    const auto tension = recorded.tension(row * kRecordPeriod);
    csv += fmt::format("{:.2f},{},0,{},0", row * kRecordPeriod, tension[0], tension[1]);
    for (const double q : state.q) csv += fmt::format(",{:.5f}", q + noise(recorded.angle_noise));
    if (recorded.rates) {
      for (const double v : state.v) csv += fmt::format(",{:.5f}", v + noise(recorded.rate_noise));
    }
    for (const double x : chain.Tip(state.q))
      csv += fmt::format(",{:.5f}", x + noise(recorded.tip_noise));
    csv += "\n";
  }
  return csv;
}

}  // namespace

std::vector<std::string> Record(const PlanarChain& chain, double stop, const Recorded& recorded,
                                const std::vector<std::uint64_t>& seeds) {
  const auto motion = Motion(chain, stop, recorded);
  std::vector<std::string> csvs;
  for (const std::uint64_t seed : seeds) csvs.push_back(Csv(chain, recorded, motion, seed));
  return csvs;
}

}  // namespace continuum
