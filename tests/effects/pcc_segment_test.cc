#include "effects/pcc_segment.h"

#include <random>

#include <ceres/jet.h>
#include <gtest/gtest.h>

namespace continuum {
namespace {

using Law = PccSegmentLaw;
using Three = Vec<double, 3>;

Law::Params<double> Table() {
  Law::Params<double> p;
  for (std::size_t i = 0; i < p.size(); ++i) p[i] = Law::kParams[i].initial;
  return p;
}
Law::Params<double> Without(std::initializer_list<std::string_view> names) {
  auto p = Table();
  for (std::size_t i = 0; i < p.size(); ++i) {
    for (const auto name : names) {
      if (Law::kParams[i].name == name) p[i] = 0;
    }
  }
  return p;
}

struct PccSegmentLawTest : ::testing::Test {
  std::mt19937 rng{1};
  Three Random(double scale) {
    std::uniform_real_distribution<double> unit(-scale, scale);
    return {unit(rng), unit(rng), unit(rng)};
  }
};

TEST_F(PccSegmentLawTest, AtRestItGivesNothing) {
  for (const double force : Law::Eval<double>({}, {}, {}, 0, Table())) EXPECT_EQ(force, 0);
}

TEST_F(PccSegmentLawTest, StraightOneChamberBendsAndLengthensByItsLever) {
  const auto p = Without({"x_m", "y_m"});
  const Three one = Law::Eval<double>({}, {}, {4e4, 0, 0}, 0, p);
  EXPECT_NEAR(one[0], 31e-6 * 4e4 * 0.03 / 0.05, 1e-15);
  EXPECT_NEAR(one[1], 0, 1e-15);
  EXPECT_NEAR(one[2], 31e-6 * 4e4, 1e-15);
  // The other two lie at +x, below and above: together they bend toward −x as much as one does.
  const Three two = Law::Eval<double>({}, {}, {0, 4e4, 4e4}, 0, p);
  EXPECT_NEAR(two[0], -one[0], 1e-15);
  EXPECT_NEAR(two[1], 0, 1e-15);
  const Three second = Law::Eval<double>({}, {}, {0, 4e4, 0}, 0, p);
  EXPECT_NEAR(second[1], std::sqrt(0.75) * one[0], 1e-15);
}

TEST_F(PccSegmentLawTest, EqualPressuresBendOnlyByTheOffsetOfTheirCentre) {
  const Three force = Law::Eval<double>({}, {}, {4e4, 4e4, 4e4}, 0, Table());
  const double push = 3 * 31e-6 * 4e4;
  EXPECT_NEAR(force[0], push * -0.4e-3 / 0.05, 1e-15);
  EXPECT_NEAR(force[1], push * -1.5e-3 / 0.05, 1e-15);
  EXPECT_NEAR(force[2], push, 1e-15);
}

TEST_F(PccSegmentLawTest, ClosedChambersDoTheWorkOfTheirVolume) {
  const auto p = Without({"k_theta", "k_theta3", "k_dL1", "k_dL3"});
  const Three pressure{3e4, 1e4, 2e4};
  const auto work = [&](const Three& delta) {  // Σ p_i A (L − r_ix u − r_iy v)
    double sum = 0;
    for (int i = 0; i < 3; ++i) {
      const auto r = PccChamber(Law::Chambers(p), i);
      const double u = delta[0] / p[1], v = delta[1] / p[1];
      sum += pressure[i] * p[5] * (p[0] + delta[2] - r[0] * u - r[1] * v);
    }
    return sum;
  };
  for (int k = 0; k < 20; ++k) {
    const Three delta = Random(0.05);
    const Three force = Law::Eval<double>(delta, {}, pressure, 1, p);
    for (int i = 0; i < 3; ++i) {
      Three ahead = delta, behind = delta;
      ahead[i] += 1e-3, behind[i] -= 1e-3;
      EXPECT_NEAR(force[i], (work(ahead) - work(behind)) / 2e-3, 1e-12);  // it is linear
    }
  }
}

// The pressures' work is that of a load on the moving tip: f_z along its axis and the moments on
// its turning, with the pose taken from the kinematics and differentiated by duals.
TEST_F(PccSegmentLawTest, PressureDoesTheWorkOfTheTipLoadThatItIs) {
  using Dual = ceres::Jet<double, 1>;
  const auto p = Without({"k_theta", "k_theta3", "k_dL1", "k_dL3"});
  for (int k = 0; k < 200; ++k) {
    const Three delta = Random(0.05), rate = Random(1);
    Three pressure = Random(3e4);
    for (double& x : pressure) x = std::abs(x);
    const Three drive = Law::Eval<double>(delta, {}, pressure, 0, p);
    Vec<Dual, 3> moved;
    for (int i = 0; i < 3; ++i) {
      moved[i].a = delta[i];
      moved[i].v[0] = rate[i];
    }
    const PccTip<Dual> tip = PccTipPose(PccSegment<Dual>{Dual(p[0]), Dual(p[1])}, moved);
    const auto turning = PccTipPose(Law::Segment(p), delta).turning;
    const PccLoad<double> load = PccPressureLoad(Law::Chambers(p), pressure);
    double power = 0, along = 0;
    for (int i = 0; i < 3; ++i) {
      along += tip.rotation[i][2].a * tip.position[i].v[0];
      power -= drive[i] * rate[i];
      power += (turning[0][i] * load.m_x + turning[1][i] * load.m_y) * rate[i];
    }
    EXPECT_NEAR(power + load.f_z * along, 0, 1e-13 * load.f_z);
  }
}

TEST_F(PccSegmentLawTest, TheBodyStoresWhatItDoesNotDamp) {
  const auto p = Table();
  const auto energy = [&](const Three& x) {
    double sum = 0;
    for (int i = 0; i < 3; ++i) {
      const double k1 = p[i < 2 ? 8 : 10], k3 = p[i < 2 ? 9 : 11];
      sum += 0.5 * k1 * x[i] * x[i] + 0.25 * k3 * std::pow(x[i], 4);
    }
    return sum;
  };
  for (int k = 0; k < 200; ++k) {
    const Three delta = Random(0.03), rate = Random(0.5);
    const Three force = Law::Eval<double>(delta, rate, {}, 0, p);
    const double h = 1e-6;
    Three ahead, behind;
    double power = 0;
    for (int i = 0; i < 3; ++i) {
      ahead[i] = delta[i] + h * rate[i];
      behind[i] = delta[i] - h * rate[i];
      power -= force[i] * rate[i];  // into the segment
    }
    const double stored = (energy(ahead) - energy(behind)) / (2 * h);
    const double lost = p[6] * (rate[0] * rate[0] + rate[1] * rate[1]) + p[7] * rate[2] * rate[2];
    EXPECT_NEAR(power, stored + lost, 1e-8);  // rounding of energies of 1 J over 2e-6 s
  }
}

TEST_F(PccSegmentLawTest, ElongationSoftensToNothingAt44Point7Millimetres) {
  using Dual = ceres::Jet<double, 1>;
  const auto p = Table();
  Law::Params<Dual> dual;
  for (std::size_t i = 0; i < p.size(); ++i) dual[i] = Dual(p[i]);
  const double fold = std::sqrt(-p[10] / (3 * p[11]));
  EXPECT_NEAR(fold, 44.7e-3, 5e-5);
  const Vec<Dual, 3> zero{};
  const auto stiffness = [&](double l) {
    return -Law::Eval<Dual>({Dual(0.0), Dual(0.0), Dual(l, 0)}, zero, zero, 0, dual)[2].v[0];
  };
  EXPECT_NEAR(stiffness(0), p[10], 1e-12);
  EXPECT_NEAR(stiffness(fold), 0, 1e-10);
}

}  // namespace
}  // namespace continuum
