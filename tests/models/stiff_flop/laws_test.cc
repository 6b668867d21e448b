#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "models/stiff_flop/body.h"
#include "models/stiff_flop/chamber.h"

namespace continuum::stiff_flop {

static void PrintTo(BodyLaw law, std::ostream* out) {
  constexpr const char* kNames[] = {"Fixed", "Elongation", "Simple", "Planar", "General"};
  *out << kNames[static_cast<int>(law)];
}

namespace {

using std::numbers::pi;
using Dual = ceres::Jet<double, 2>;

constexpr double kInner = 2.5e-3, kOuter = 3e-3;
constexpr std::array kChambers = {ChamberLaw::kFixed, ChamberLaw::kElongation, ChamberLaw::kExact,
                                  ChamberLaw::kConstant};
constexpr std::array kBodies = {BodyLaw::kFixed, BodyLaw::kElongation, BodyLaw::kSimple,
                                BodyLaw::kPlanar, BodyLaw::kGeneral};

Chamber<double> Tube(ChamberLaw law, double gamma, double lambda, double kappa) {
  return {law, gamma, kInner, kOuter, {lambda, kappa}};
}

Body<double> Solid(BodyLaw law, double lambda, double kappa) { return {law, {lambda, kappa}}; }

// z*/z of the body laws that the tests know.
double Width(BodyLaw law, double lambda, double kappa, double x) {
  if (law == BodyLaw::kFixed) return 1;
  const double u = law == BodyLaw::kSimple || law == BodyLaw::kGeneral ? 1 - kappa * x : 1;
  return 1 / std::sqrt(lambda * u);
}

// Integral of f over a disk, independent of the library's rule.
double OverDisk(double r, const std::function<double(double, double)>& f) {
  constexpr int kRings = 200, kSpokes = 400;
  double sum = 0;
  for (int i = 0; i < kRings; ++i) {
    const double rho = r * (i + 0.5) / kRings;
    for (int j = 0; j < kSpokes; ++j) {
      const double angle = 2 * pi * j / kSpokes;
      sum += rho * f(rho * std::cos(angle), rho * std::sin(angle));
    }
  }
  return sum * (r / kRings) * (2 * pi / kSpokes);
}

TEST(StiffFlopChamber, KeepsItsRadiusWhenTheThreadsAreRings) {
  for (const ChamberLaw law : kChambers) {
    for (const double cosine : {-1.0, 0.3, 1.0}) {
      EXPECT_NEAR(Tube(law, pi / 2, 1.4, 60).Radius(cosine, kOuter), 1, 1e-15);
    }
    EXPECT_NEAR(Tube(law, pi / 2, 1.4, 60).GasArea(), pi * kInner * kInner, 1e-19);
  }
}

TEST(StiffFlopChamber, RadiiTendToThoseOfRingsAsTheSquareOfTheCotangent) {
  for (const ChamberLaw law : kChambers) {
    const double near = Tube(law, pi / 2 - 1e-3, 1.4, 60).Radius(0.7, kOuter) - 1;
    const double far = Tube(law, pi / 2 - 2e-3, 1.4, 60).Radius(0.7, kOuter) - 1;
    EXPECT_NEAR(far, 4 * near, 1e-9) << static_cast<int>(law);
  }
}

TEST(StiffFlopChamber, ConstantLeadAngleIsPureElongationWhenStraight) {
  const auto bent = Tube(ChamberLaw::kConstant, 1.2, 1.3, 0);
  const auto straight = Tube(ChamberLaw::kElongation, 1.2, 1.3, 0);
  EXPECT_NEAR(bent.GasArea(), straight.GasArea(), 1e-14 * straight.GasArea());
  EXPECT_NEAR(bent.Wall(), straight.Wall(), 1e-12 * straight.Wall());
}

TEST(StiffFlopChamber, EveryLawRestsAtUnitStretch) {
  for (const ChamberLaw law : kChambers) {
    EXPECT_NEAR(Tube(law, 1.2, 1, 0).GasArea(), pi * kInner * kInner, 1e-19);
    EXPECT_NEAR(Tube(law, 1.2, 1, 0).Wall(), 0, 1e-20);
  }
}

// (26, 27): the thread's length, with the lead angle of each law.
TEST(StiffFlopChamber, BentThreadsKeepTheirLength) {
  const double gamma = 1.3, lambda = 1.25, kappa = 70;
  for (const double cosine : {-1.0, -0.4, 0.0, 0.6, 1.0}) {
    const auto tube = Tube(ChamberLaw::kConstant, gamma, lambda, kappa);
    const double x = tube.Radius(cosine, kOuter);
    const double y = tube.Fibre(cosine, kOuter, x);
    EXPECT_NEAR(std::pow(x * std::sin(gamma), 2) + std::pow(y * std::cos(gamma), 2), 1, 1e-14);
  }
}

// The coefficients of (28) as printed, with whole turns n = l tan(gamma)/(2 pi r).
TEST(StiffFlopChamber, ExactHelixSolvesThePrintedQuadratic) {
  const double gamma = 1.35, lambda = 1.3, kappa = 40, r = kOuter, l = 0.044;
  const double n = l * std::tan(gamma) / (2 * pi * r);
  const auto tube = Tube(ChamberLaw::kExact, gamma, lambda, kappa);
  for (const double cosine : {-1.0, -0.2, 0.5, 1.0}) {
    const double turns = std::pow(8 * n * pi * cosine * cosine + 4 * pi * n, 2);
    const double common = l * l * (std::cos(2 * gamma) - 1) * turns /
                          (4 * n * n * pi * pi * std::pow(4 * pi * n, 2) *
                           (lambda * lambda * (std::cos(2 * gamma) + 1) - 2));
    const double lambda4 = std::pow(lambda, 4);
    const double a12 = common * lambda4 * std::pow(kappa * cosine, 2) + 1;
    const double a11 = -2 * common * lambda4 * kappa * cosine / r;
    const double a10 = common * (lambda4 - lambda * lambda) / (r * r) - 1;
    const double x = tube.Radius(cosine, r);
    EXPECT_NEAR(a12 * x * x + a11 * x + a10, 0, 1e-12);
    EXPECT_GT(x, 0);
  }
}

TEST(StiffFlopChamber, GasVolumeIsStationaryAtTheNeutralAngle) {
  const double gamma = 1.3;
  const double lambda = 1 / (std::sqrt(3) * std::cos(gamma));  // cos^2 gamma_e = 1/3
  const Chamber<Dual> tube(ChamberLaw::kElongation, Dual(gamma), kInner, kOuter,
                           {Dual(lambda, 0), Dual(0.0, 1)});
  const Dual volume = Dual(lambda, 0) * tube.GasArea();
  EXPECT_NEAR(volume.v[0] / volume.a, 0, 1e-13);
}

// p = E (r_2^2 - r_1^2)(lambda^4 - 1)/(3 lambda^3 r_1^2) of one tube of fixed radius.
TEST(StiffFlopChamber, OneFixedTubeNeedsThePressureOfItsVirtualWork) {
  const double lambda = 1.3;
  const Chamber<Dual> tube(ChamberLaw::kFixed, Dual(1.2), kInner, kOuter,
                           {Dual(lambda, 0), Dual(0.0, 1)});
  const double p = tube.Wall().v[0] / 6 / (Dual(lambda, 0) * tube.GasArea()).v[0];
  const double wall = kOuter * kOuter - kInner * kInner;
  EXPECT_NEAR(p, wall * (std::pow(lambda, 4) - 1) / (3 * std::pow(lambda, 3) * kInner * kInner),
              1e-14);
}

TEST(StiffFlopChamber, WallAndGasAgreeWithPlainSums) {
  constexpr int kRadii = 2000, kAngles = 720;
  for (const ChamberLaw law : {ChamberLaw::kExact, ChamberLaw::kConstant}) {
    const auto tube = Tube(law, 1.35, 1.3, 90);
    double wall = 0, gas = 0;
    for (int j = 0; j < kAngles; ++j) {
      const double cosine = std::cos(2 * pi * j / kAngles);
      gas += std::pow(tube.Radius(cosine, kInner) * kInner, 2) / 2 * 2 * pi / kAngles;
      for (int i = 0; i < kRadii; ++i) {
        const double r = kInner + (kOuter - kInner) * (i + 0.5) / kRadii;
        const double x = tube.Radius(cosine, r);
        const double y = tube.Fibre(cosine, r, x);
        wall += (x * x + y * y + 1 / std::pow(x * y, 2) - 3) * r * (kOuter - kInner) / kRadii * 2 *
                pi / kAngles;
      }
    }
    EXPECT_NEAR(tube.GasArea(), gas, 1e-12 * gas);
    EXPECT_NEAR(tube.Wall(), wall, 1e-7 * wall);  // the midpoint rule over r
  }
}

// A point close to the fold is the hardest for the quadrature; here it is compared with itself at
// eightfold resolution through a thick wall cut into shells.
TEST(StiffFlopChamber, WallOfShellsIsTheWallOfTheWhole) {
  const Bend<double> bend{1.2, 250};
  const Chamber<double> whole(ChamberLaw::kConstant, 1.3, 0.5e-3, 3e-3, bend);
  double sum = 0;
  for (int i = 0; i < 8; ++i) {
    const double r = 0.5e-3 + i * (2.5e-3 / 8);
    sum += Chamber<double>(ChamberLaw::kConstant, 1.3, r, r + 2.5e-3 / 8, bend).Wall();
  }
  EXPECT_NEAR(whole.Wall(), sum, 1e-9 * sum);
}

TEST(StiffFlopChamber, MarginEndsWhereTheThreadIsStraightOrTheWallFolds) {
  for (const ChamberLaw law : {ChamberLaw::kElongation, ChamberLaw::kConstant}) {
    EXPECT_GT(Tube(law, 1.0, 0.999 / std::cos(1.0), 0).Margin(), 0);
    EXPECT_LT(Tube(law, 1.0, 1.001 / std::cos(1.0), 0).Margin(), 0);
  }
  EXPECT_LT(Tube(ChamberLaw::kConstant, 1.5, 1.2, 1 / kOuter).Margin(), 0);
  // Radius 0 at psi = pi: 9 cot^2(gamma_e) (lambda^2 - 1) = 1.
  EXPECT_LT(Tube(ChamberLaw::kExact, 1.25, 1.3, 90).Margin(), 0);
  EXPECT_LT(Tube(ChamberLaw::kExact, 1.25, 1.3, 90).Radius(-1, kOuter), 0);
  EXPECT_GT(Tube(ChamberLaw::kFixed, 1.0, 5, 0).Margin(), 0);
}

class StiffFlopBody : public testing::TestWithParam<BodyLaw> {};
INSTANTIATE_TEST_SUITE_P(All, StiffFlopBody, testing::ValuesIn(kBodies),
                         testing::PrintToStringParamName());

TEST_P(StiffFlopBody, StraightBodyOnlyContracts) {
  if (GetParam() == BodyLaw::kFixed) return;
  const auto straight = Solid(BodyLaw::kElongation, 1.3, 0);
  for (const double kappa : {0.0, 1e-8}) {
    const auto body = Solid(GetParam(), 1.3, kappa);
    EXPECT_NEAR(body.Energy(0.01), straight.Energy(0.01), 1e-14 * straight.Energy(0.01));
    EXPECT_NEAR(body.Deformed(0.01).area, straight.Deformed(0.01).area, 1e-17);
    EXPECT_NEAR(body.Deformed(0.01).x2, straight.Deformed(0.01).x2, 1e-21);
    EXPECT_NEAR(body.Deformed(0.01).z2, straight.Deformed(0.01).z2, 1e-21);
    EXPECT_NEAR(body.Shifted(0.01), straight.Shifted(0.01), 1e-11);
  }
}

TEST_P(StiffFlopBody, DerivativesOfTheEnergyAreThoseOfDifferences) {
  const double lambda = 1.2, r = 0.012, h = 1e-6;
  for (const double kappa : {0.0, 1e-4, 5.0, 25.0}) {
    const Body<Dual> body(GetParam(), {Dual(lambda, 0), Dual(kappa, 1)});
    const auto energy = [&](double l, double k) { return Solid(GetParam(), l, k).Energy(r); };
    const double by_lambda = (energy(lambda + h, kappa) - energy(lambda - h, kappa)) / (2 * h);
    const double step = 1e-3;
    const double by_kappa =
        (energy(lambda, kappa + step) - energy(lambda, kappa - step)) / (2 * step);
    EXPECT_NEAR(body.Energy(r).v[0], by_lambda, 1e-8 * std::abs(by_lambda));
    EXPECT_NEAR(body.Energy(r).v[1], by_kappa, 1e-12);
  }
}

TEST_P(StiffFlopBody, SmallBendingEnergyHasTheStiffnessOfItsKinematics) {
  const double kappa = 0.05, r = 0.01;
  const double ratio =
      Solid(GetParam(), 1, kappa).Energy(r) / 6 / (pi * std::pow(r, 4) / 4 * kappa * kappa / 2);
  const double expected = std::array{1.0, 0.0, 1.0, 4.0 / 3, 13.0 / 12}[int(GetParam())];
  EXPECT_NEAR(ratio, expected, 1e-6);  // next term of the order (kappa r)^2
}

// Determinant of the map and I_1 = |F|^2 from differences of the map (37), for a point (x, 0, z).
struct Deformation {
  BodyLaw law;
  double lambda, kappa;

  std::array<double, 3> Map(double x, double y, double z) const {
    const double shifted = Solid(law, lambda, kappa).Shifted(x);
    const double angle = kappa * lambda * y;
    return {std::cos(angle) * shifted + (1 - std::cos(angle)) / kappa,
            std::sin(angle) * (1 / kappa - shifted), Width(law, lambda, kappa, x) * z};
  }

  std::pair<double, double> InvariantAndVolume(double x, double z) const {
    const double h = 1e-6;
    std::array<std::array<double, 3>, 3> f;
    for (int k = 0; k < 3; ++k) {
      const std::array<double, 3> d = {k == 0 ? h : 0, k == 1 ? h : 0, k == 2 ? h : 0};
      const auto above = Map(x + d[0], d[1], z + d[2]);
      const auto below = Map(x - d[0], -d[1], z - d[2]);
      for (int i = 0; i < 3; ++i) f[i][k] = (above[i] - below[i]) / (2 * h);
    }
    double invariant = 0;
    for (const auto& row : f) {
      for (const double entry : row) invariant += entry * entry;
    }
    const double volume = f[0][0] * (f[1][1] * f[2][2] - f[1][2] * f[2][1]) -
                          f[0][1] * (f[1][0] * f[2][2] - f[1][2] * f[2][0]) +
                          f[0][2] * (f[1][0] * f[2][1] - f[1][1] * f[2][0]);
    return {invariant, volume};
  }
};

TEST(StiffFlopSolid, PlanarAndGeneralLawsKeepTheVolumeOfEveryElement) {
  for (const BodyLaw law : {BodyLaw::kPlanar, BodyLaw::kGeneral}) {
    const Deformation map{law, 1.3, 30};
    for (const double x : {-0.012, -0.004, 0.0, 0.006, 0.012}) {
      for (const double z : {-0.01, 0.003}) {
        EXPECT_NEAR(map.InvariantAndVolume(x, z).second, 1, 1e-8);
      }
    }
  }
}

TEST(StiffFlopSolid, EnergyIsThatOfTheDeformationGradient) {
  const double r = 0.012;
  for (const BodyLaw law : {BodyLaw::kPlanar, BodyLaw::kGeneral}) {
    for (const double lambda : {0.9, 1.3, 1.9}) {
      const Deformation map{law, lambda, 25};
      const double expected =
          OverDisk(r, [&](double x, double z) { return map.InvariantAndVolume(x, z).first - 3; });
      // The midpoint rule over 200 rings.
      EXPECT_NEAR(Solid(law, lambda, 25).Energy(r), expected, 3e-5 * expected);
    }
  }
}

TEST(StiffFlopSolid, SimpleLawIntegratesItsInvariant) {
  const double lambda = 1.2, kappa = 60, r = 0.012;
  const double expected = OverDisk(r, [&](double x, double) {
    const double y = lambda * (1 - kappa * x);
    return y * y + 2 / y - 3;
  });
  EXPECT_NEAR(Solid(BodyLaw::kSimple, lambda, kappa).Energy(r), expected, 1e-4 * expected);
}

// Area and moments of the outline itself, by Green's theorem around the mapped circle.
TEST_P(StiffFlopBody, DeformedSectionIsTheOneInsideTheMovedOutline) {
  const double lambda = 1.3, kappa = 30, r = 0.0125;
  constexpr int kPoints = 20000;
  double area = 0, x2 = 0, z2 = 0;
  const auto body = Solid(GetParam(), lambda, kappa);
  const auto point = [&](int j) {
    const double angle = 2 * pi * j / kPoints;
    const double x = r * std::cos(angle);
    return std::pair{body.Shifted(x), r * std::sin(angle) * Width(GetParam(), lambda, kappa, x)};
  };
  for (int j = 0; j < kPoints; ++j) {
    const auto [a, b] = point(j);
    const auto [c, d] = point(j + 1);
    const double cross = a * d - c * b;
    area += cross / 2;
    x2 += cross * (a * a + a * c + c * c) / 12;
    z2 += cross * (b * b + b * d + d * d) / 12;
  }
  const Section<double> section = body.Deformed(r);
  EXPECT_NEAR(section.area, area, 1e-7 * area);  // the polygon's error
  EXPECT_NEAR(section.x2, x2, 1e-7 * x2);
  EXPECT_NEAR(section.z2, z2, 1e-7 * z2);
}

TEST(StiffFlopSolid, MarginEndsWhereTheSectionFolds) {
  EXPECT_LT(Solid(BodyLaw::kSimple, 1, 100.1).Margin(0.01), 0);
  EXPECT_GT(Solid(BodyLaw::kSimple, 1, 99.9).Margin(0.01), 0);
  EXPECT_LT(Solid(BodyLaw::kPlanar, 1, 50.1).Margin(0.01), 0);
  EXPECT_GT(Solid(BodyLaw::kPlanar, 1, 49.9).Margin(0.01), 0);
  const double fold = 100 * (1 - std::cbrt(1.0 / 16));  // 4 (1 - kappa r)^(3/2) = 1
  EXPECT_LT(Solid(BodyLaw::kGeneral, 1, fold + 0.01).Margin(0.01), 0);
  EXPECT_GT(Solid(BodyLaw::kGeneral, 1, fold - 0.01).Margin(0.01), 0);
}

// Near the fold 1/sqrt(D) is steep: the rule must still agree with shells, each of which has its
// own number of points.
TEST(StiffFlopSolid, QuadratureHoldsNearTheFold) {
  const double kappa = 100 * (1 - std::cbrt(1.0 / 16)) * (1 - 1e-3), r = 0.01;
  const auto body = Solid(BodyLaw::kGeneral, 1, kappa);
  constexpr int kPoints = 200000;
  double area = 0;
  for (int j = 0; j < kPoints; ++j) {
    const auto at = [&](int i) {
      const double angle = 2 * pi * i / kPoints;
      const double x = r * std::cos(angle);
      return std::pair{body.Shifted(x), r * std::sin(angle) / std::sqrt(1 - kappa * x)};
    };
    const auto [a, b] = at(j);
    const auto [c, d] = at(j + 1);
    area += (a * d - c * b) / 2;
  }
  EXPECT_NEAR(body.Deformed(r).area, area, 2e-9 * area);
}

TEST(StiffFlopArc, SeriesJoinTheClosedForms) {
  for (const double x : {0.3, 0.999999, 1.000001, 3.0}) {
    const std::array<double, 4> c = ArcSeries(x);
    EXPECT_NEAR(c[0], std::cos(x), 1e-15);
    EXPECT_NEAR(c[1], std::sin(x) / x, 1e-15);
    EXPECT_NEAR(c[2], 2 * std::pow(std::sin(x / 2) / x, 2), 1e-15);
    EXPECT_NEAR(c[3], (x - std::sin(x)) / (x * x * x), 1e-13);
  }
}

}  // namespace
}  // namespace continuum::stiff_flop
