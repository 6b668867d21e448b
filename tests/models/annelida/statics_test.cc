#include "models/annelida/statics.h"

#include <cmath>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "models/annelida/annelida.h"
#include "sim/model/model_spec.h"

namespace continuum {
namespace {

using Eigen::Vector3d, Eigen::VectorXd;

AnnelidaParameters Arm(std::vector<int> sections = {5}) {
  AnnelidaParameters p =
      ReadAnnelida(std::string(CONTINUUM_SOURCE) + "/models/annelida/annelida.yaml");
  p.sections = std::move(sections);
  return p;
}

// Tensions of some cables (from 1), the others slack.
AnnelidaLoad Pulling(const AnnelidaParameters& p, std::vector<std::pair<int, double>> cables) {
  AnnelidaLoad load{VectorXd::Zero(p.Cables())};
  for (const auto& [cable, tension] : cables) load.tension[cable - 1] = tension;
  return load;
}

// From (4): K q = T (a cos(q/2) + b sin(q/2)) in every joint, which one number solves by halving.
double BendOfAJoint(const AnnelidaParameters& p, double tension) {
  double low = 0, high = 1;
  for (int i = 0; i < 60; ++i) {
    const double q = (low + high) / 2;
    const double excess = p.K * q - tension * (p.a * std::cos(q / 2) + p.b1 * std::sin(q / 2));
    (excess < 0 ? low : high) = q;
  }
  return low;
}

TEST(AnnelidaStatics, WithoutWeightAndFrictionEveryJointBendsAlike) {
  AnnelidaParameters p = Arm();
  p.gravity = 0;
  const double q = BendOfAJoint(p, 15);
  ASSERT_GT(q, 0.3);
  const AnnelidaLoad load = Pulling(p, {{1, 15}});
  const AnnelidaShape chain = SolveChain(p, load, AnnelidaPull::kEven);
  ASSERT_TRUE(chain.outcome.ok());
  for (int i = 0; i < 5; ++i) {
    EXPECT_NEAR(chain.joints[2 * i], 0, 1e-12);
    EXPECT_NEAR(chain.joints[2 * i + 1], q, 1e-10);
  }
  const AnnelidaShape arcs = SolveArcs(p, load);
  ASSERT_TRUE(arcs.outcome.ok());
  EXPECT_NEAR(arcs.sections[0].v, 5 * q, 1e-10);
  EXPECT_NEAR(arcs.sections[0].u, 0, 1e-12);
}

// The friction of the joints that a cable has passed takes its part of the tension, eq. 8.
TEST(AnnelidaStatics, PulledSlowlyATheFirstJointLosesWhatHalfItsAngleTakes) {
  AnnelidaParameters p = Arm({1});
  p.gravity = 0;
  const AnnelidaShape shape = SolveChain(p, Pulling(p, {{1, 15}}), AnnelidaPull::kSlowly);
  ASSERT_TRUE(shape.outcome.ok());
  const double q = shape.joints[1];
  EXPECT_NEAR(BendOfAJoint(p, 15 * std::exp(-p.mu * q / 2)), q, 1e-10);
}

// MuJoCo's own equilibrium of the generated arm, without dry friction, when it has come to rest.
VectorXd AtRest(AnnelidaParameters p, const AnnelidaLoad& load) {
  p.tau_c = p.mu = 0;
  p.tau_mu = 0.3;
  const ModelAndData machine = ModelSpec::Parse(AnnelidaMjcf(p)).Build();
  mjData& d = *machine.data;
  for (Eigen::Index j = 0; j < load.tension.size(); ++j) d.ctrl[j] = load.tension[j];
  while (d.time < 8) mj_step(machine.model.get(), &d);
  return Eigen::Map<const VectorXd>(d.qpos, machine.model->nq);
}

TEST(AnnelidaStatics, TheChainIsTheGeneratedArmWithAnySectionsAndTorsion) {
  for (const auto& sections : {std::vector{5}, {3, 2}, {2, 1, 3}}) {
    for (const bool torsion : {false, true}) {
      AnnelidaParameters p = Arm(sections);
      if (torsion) p.torsion = {2.0, 0.05};
      AnnelidaLoad load = Pulling(p, {{1, 7}, {2, 3}, {p.Cables(), 6}, {p.Cables() - 1, 2}});
      const AnnelidaShape shape = SolveChain(p, load, AnnelidaPull::kEven);
      ASSERT_TRUE(shape.outcome.ok()) << shape.outcome.why;
      EXPECT_TRUE(shape.stability.stable());
      const VectorXd q = AtRest(p, load);
      ASSERT_EQ(q.size(), shape.joints.size());
      // The slowest motion has fallen below this.
      EXPECT_LT((q - shape.joints).cwiseAbs().maxCoeff(), 1e-7) << p.Links() << torsion;
      if (torsion) {
        EXPECT_GT(std::abs(q[2]), 1e-5);
      }
    }
  }
}

// All holes slide at the end of a slow pull; joints have no dry friction here.
TEST(AnnelidaStatics, PulledSlowlyTheChainIsTheArmWithCableFriction) {
  AnnelidaParameters p = Arm({2, 2});
  p.tau_c = 0;
  p.tau_mu = 0.01;
  const AnnelidaLoad load = Pulling(p, {{1, 10}, {6, 5}});
  const AnnelidaShape pulled = SolveChain(p, load, AnnelidaPull::kSlowly);
  const AnnelidaShape even = SolveChain(p, load, AnnelidaPull::kEven);
  const ModelAndData machine = ModelSpec::Parse(AnnelidaMjcf(p)).Build();
  mjData& d = *machine.data;
  constexpr double kRise = 10;
  while (d.time < kRise) {
    for (Eigen::Index j = 0; j < load.tension.size(); ++j)
      d.ctrl[j] = load.tension[j] * d.time / kRise;
    mj_step(machine.model.get(), &d);
  }
  const VectorXd q = Eigen::Map<const VectorXd>(d.qpos, machine.model->nq);
  const double friction = (pulled.joints - even.joints).cwiseAbs().maxCoeff();
  EXPECT_GT(friction, 5e-3);
  // It lags behind by what it moves in tau_mu/K.
  EXPECT_LT((q - pulled.joints).cwiseAbs().maxCoeff(), 0.1 * friction);
}

TEST(AnnelidaStatics, EqualPullsFromAllSidesKeepTheArmStraightUntilItBuckles) {
  const AnnelidaParameters p = Arm({2, 2});
  AnnelidaLoad load = Pulling(p, {});
  load.tension.setConstant(5);
  const AnnelidaShape little = SolveChain(p, load, AnnelidaPull::kEven);
  ASSERT_TRUE(little.outcome.ok());
  EXPECT_TRUE(little.stability.stable());
  EXPECT_LT(little.joints.cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_LT(SolveArcs(p, load).sections[1].Angle(), 1e-12);
  // Straight, n cables of tension T take n T b1/2 from K, more than the weight adds.
  load.tension.setConstant(100);
  const AnnelidaShape much = SolveChain(p, load, AnnelidaPull::kEven);
  EXPECT_FALSE(much.stability.stable());
}

TEST(AnnelidaStatics, TheCablesOfASectionBendItAloneWithoutWeight) {
  AnnelidaParameters p = Arm({3, 2});
  p.gravity = 0;
  // A cable of the second section passes the first: both bend. One of the first ends there.
  const AnnelidaShape first = SolveArcs(p, Pulling(p, {{2, 10}}));
  ASSERT_TRUE(first.outcome.ok());
  EXPECT_NEAR(first.sections[0].Azimuth(), std::numbers::pi / 2, 1e-10);
  EXPECT_LT(first.sections[1].Angle(), 1e-10);
  const AnnelidaShape second = SolveArcs(p, Pulling(p, {{5, 10}}));
  ASSERT_TRUE(second.outcome.ok());
  for (const Arc& arc : second.sections) {
    EXPECT_NEAR(arc.Azimuth(), std::numbers::pi / 4, 1e-10);
  }
  EXPECT_NEAR(second.sections[0].Angle() / 3, second.sections[1].Angle() / 2, 1e-10);
}

// Energy by integration of the force along the way: the work of a cable is T times what comes out.
TEST(AnnelidaStatics, TheTensionIsTheSlopeOfTheStoredEnergyByTheCablesLength) {
  AnnelidaParameters p = Arm({2, 3});
  const auto energy = [&](const AnnelidaShape& shape) {
    double e = 0;
    for (std::size_t s = 0; s < p.sections.size(); ++s) {
      e += p.K * std::pow(shape.sections[s].Angle(), 2) / (2 * p.sections[s]);
    }
    double along = 0;  // lowest point of each link's centre, by the arcs alone
    Eigen::Isometry3d base = Eigen::Isometry3d::Identity();
    for (std::size_t s = 0; s < p.sections.size(); ++s) {
      const Arc arc = shape.sections[s];
      for (int i = 1; i <= p.sections[s]; ++i) {
        const double share = (i * p.Pitch() - p.b2 / 2) / arc.s;
        const Eigen::Isometry3d at = base * ArcPose({share * arc.u, share * arc.v, share * arc.s});
        const bool last = s == 1 && i == p.sections[s];
        along += (last ? p.m_last : p.m) * at.translation().z();
      }
      base = base * ArcPose(arc);
    }
    return e - p.gravity * along;
  };
  constexpr double kStep = 1e-3;
  const auto at = [&](double t) { return SolveArcs(p, Pulling(p, {{2, 6}, {7, t}})); };
  const AnnelidaShape less = at(9 - kStep), more = at(9 + kStep);
  ASSERT_TRUE(less.outcome.ok() && more.outcome.ok());
  const VectorXd out = more.length - less.length;
  EXPECT_NEAR(energy(more) - energy(less), -(6 * out[1] + 9 * out[6]), 1e-9);
}

TEST(AnnelidaStatics, LengthsGiveBackTheArcsOfAnySections) {
  for (const auto& sections : {std::vector{5}, {3, 2}, {2, 1, 3}}) {
    const AnnelidaParameters p = Arm(sections);
    const AnnelidaShape shape = SolveArcs(p, Pulling(p, {{1, 7}, {4, 3}, {p.Cables(), 5}}));
    const AnnelidaShape back = ArcsOfLengths(p, shape.length);
    ASSERT_TRUE(back.outcome.ok());
    EXPECT_LT(back.mismatch, 1e-14);
    for (std::size_t s = 0; s < sections.size(); ++s) {
      EXPECT_NEAR(back.sections[s].u, shape.sections[s].u, 1e-12);
      EXPECT_NEAR(back.sections[s].v, shape.sections[s].v, 1e-12);
    }
    EXPECT_LT((back.frames.back().translation() - shape.frames.back().translation()).norm(), 1e-13);
  }
}

TEST(AnnelidaStatics, OneSectionIsThePapersComparator) {
  const AnnelidaParameters p = Arm();
  const Module module{p.a, p.b1, 5};
  const CableLengths spans = module.Lengths(0.7, 1.2);
  VectorXd lengths(4);
  for (int j = 0; j < 4; ++j) lengths[j] = spans[j] + 5 * p.b2;
  const AnnelidaShape shape = ArcsOfLengths(p, lengths);
  const Eigen::Isometry3d tip = ArcPose(Arc::Of(0.7, 1.2, p.Length()));
  EXPECT_TRUE(shape.frames.back().isApprox(tip, 1e-13));
  EXPECT_FALSE(ArcsOfLengths(p, VectorXd::Constant(4, 0.05)).outcome.ok());
}

// A moment is none of the loads; a force on the tip of an arm bent to the side twists its joints.
TEST(AnnelidaStatics, AForceOnTheTipDoesTheWorkThatMovesIt) {
  AnnelidaParameters p = Arm({4});
  p.torsion = {2.0, 0};
  AnnelidaLoad load = Pulling(p, {{1, 12}});
  constexpr double kStep = 1e-3;
  const auto tip = [&](const Vector3d& force) {
    load.force = force;
    return Vector3d(SolveChain(p, load, AnnelidaPull::kEven).frames.back().translation());
  };
  // Of a conservative arm, by y under x as by x under y.
  const Vector3d x = tip({kStep, 0.3, 0}) - tip({-kStep, 0.3, 0});
  const Vector3d y = tip({0, 0.3 + kStep, 0}) - tip({0, 0.3 - kStep, 0});
  EXPECT_NEAR(x.y(), y.x(), 1e-8);
  EXPECT_GT(std::abs(x.y()), 1e-7);
}

}  // namespace
}  // namespace continuum
