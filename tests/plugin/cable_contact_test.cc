// Several cables on shared links: every contact obeys the law at the speed that the step ends with.
#include <cmath>
#include <random>
#include <string>

#include "support/cable_arm.h"
#include "support/engine.h"

namespace continuum {
namespace {

using Arm = testing::CableArm;

constexpr double kGiveWay = 1e-3;  // of a contact at rest [m/s]

class CableContact : public testing::Engine {
 protected:
  // dL/dt of every segment of a cable at the velocities v, and the wrap angle in front of it.
  struct Segment {
    double rate, theta;
  };
  static std::vector<Segment> Segments(const mjModel* m, const mjData* d, int tendon,
                                       const std::vector<double>& v) {
    std::vector<Segment> all;
    std::vector<double> jac(3 * m->nv);
    double last[3] = {}, last_velocity[3] = {}, before[3] = {};
    for (int w = 0; w < m->tendon_num[tendon]; ++w) {
      const int site = m->wrap_objid[m->tendon_adr[tendon] + w];
      const double* const point = d->site_xpos + 3 * site;
      double velocity[3], u[3], change[3], sine[3];
      mj_jacSite(m, d, jac.data(), nullptr, site);
      mju_mulMatVec(velocity, jac.data(), v.data(), 3, static_cast<int>(m->nv));
      if (w > 0) {
        mju_sub3(u, point, last);
        mju_normalize3(u);
        mju_sub3(change, velocity, last_velocity);
        mju_cross(sine, before, u);
        all.push_back(
            {mju_dot3(u, change), w > 1 ? std::atan2(mju_norm3(sine), mju_dot3(before, u)) : 0});
        mju_copy3(before, u);
      }
      mju_copy3(last, point), mju_copy3(last_velocity, velocity);
    }
    return all;
  }

  // Checks every contact after mj_forward under RK4, whose acceleration is that of (v⁺ − v)/h.
  static int Check(const Arm& arm, const mjModel* m, const mjData* d) {
    std::vector<double> v(m->nv);
    for (int i = 0; i < m->nv; ++i) v[i] = d->qvel[i] + m->opt.timestep * d->qacc[i];
    const int cables = static_cast<int>(arm.bearings.size());
    int sliding = 0;
    for (int c = 0; c < cables; ++c) {
      const auto segments = Segments(m, d, c, v);
      const auto start = Segments(m, d, c, {d->qvel, d->qvel + m->nv});
      double rate = 0, old = 0;
      for (std::size_t k = segments.size(); k-- > 1;) {
        rate -= segments[k].rate, old -= start[k].rate;
        const double tension = d->sensordata[k * cables + c],
                     before = d->sensordata[(k - 1) * cables + c];
        if (d->ctrl[c] == 0) {
          EXPECT_EQ(tension, 0);
          continue;
        }
        const double rho = std::log(tension / before), band = arm.mu * segments[k].theta;
        EXPECT_LE(std::abs(rho), band + 1e-9);
        const bool turns = old * rate < 0 && std::abs(old) > 5 * kGiveWay;  // cable_turns_test.cc
        if (turns) continue;
        const bool slides = std::abs(rho) > band - 1e-9;
        EXPECT_LT(slides ? rho / band * rate : std::abs(rate), 4 * kGiveWay) << c << " " << k;
        sliding += slides;
      }
    }
    return sliding;
  }
};

// Tensions, speeds and memories at random. A contact at rest moves by at most 2 v_c, for what it
// remembers may be a whole band off, and the law's logarithm is taken as linear.
TEST_F(CableContact, SlidesAtTheLimitOrRests) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const double quarter = M_PI / 2;
  for (const Arm& arm :
       {Arm{.links = 1}, Arm{.links = 10}, Arm{.links = 10, .mass = 0.1},
        Arm{.links = 20, .bearings = {0, quarter, 2 * quarter, 3 * quarter}, .twisted = true},
        Arm{.links = 20, .mass = 1e-5, .mu = 0.1}}) {
    const auto m = Model(arm.Mjcf("RK4"));
    const auto d = Data(m);
    int sliding = 0;
    for (int trial = 0; trial < 40; ++trial) {
      for (int i = 0; i < m->nv; ++i) d->qpos[i] = 0.15 * uniform(random);
      for (int i = 0; i < m->nv; ++i) d->qvel[i] = 0.1 * (trial % 3) * uniform(random);
      for (int c = 0; c < m->nu; ++c) d->ctrl[c] = std::max(0.0, 2 + 4 * uniform(random));
      for (int i = 0; i < m->nwrap; ++i) d->plugin_state[i] = 0.01 * uniform(random);
      mj_forward(m.get(), d.get());
      sliding += Check(arm, m.get(), d.get());
    }
    EXPECT_GT(sliding, 0);
  }
}

// Fresh data: whatever the step does to it, a contact that moves carries the law at its own speed.
TEST_F(CableContact, OneForwardOnFreshDataGivesFullSliding) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const Arm arm{.links = 10, .mass = 0.1, .mu = 0.2, .radius = 0.03, .pitch = 0.1};
  const auto m = Model(arm.Mjcf("implicitfast"));
  const int cables = static_cast<int>(arm.bearings.size());
  int sliding = 0;
  for (int trial = 0; trial < 100; ++trial) {
    const auto d = Data(m);
    for (int i = 0; i < m->nv; ++i) d->qpos[i] = 0.15 * uniform(random);
    for (int i = 0; i < m->nv; ++i) d->qvel[i] = 2 * uniform(random);
    for (int c = 0; c < cables; ++c) d->ctrl[c] = 8 + 7 * uniform(random);
    mj_forward(m.get(), d.get());
    for (int c = 0; c < cables; ++c) {
      const auto segments =
          Segments(m.get(), d.get(), c, std::vector<double>(d->qvel, d->qvel + m->nv));
      double rate = 0;
      for (std::size_t k = segments.size(); k-- > 1;) {
        rate -= segments[k].rate;
        if (std::abs(rate) < 0.02) continue;
        const double full = std::exp(-std::copysign(arm.mu, rate) * segments[k].theta);
        EXPECT_NEAR(d->sensordata[k * cables + c], full * d->sensordata[(k - 1) * cables + c],
                    1e-6);
        ++sliding;
      }
    }
  }
  EXPECT_GT(sliding, 1000);
}

TEST_F(CableContact, ASlackCableIsNone) {
  const auto pair = Model(Arm{.bearings = {0, 2}}.Mjcf("implicitfast")),
             one = Model(Arm{.bearings = {0}}.Mjcf("implicitfast"));
  const auto d = Data(pair), e = Data(one);
  for (int k = 0; k < 300; ++k) {
    d->ctrl[0] = e->ctrl[0] = 3 + std::sin(0.05 * k);
    d->ctrl[1] = 0;
    mj_step(pair.get(), d.get());
    mj_step(one.get(), e.get());
  }
  for (int i = 0; i < pair->nv; ++i) EXPECT_NEAR(d->qpos[i], e->qpos[i], 1e-9);
}

// The middle of a bent arm is held where its ends slide: pulled, then let go a little, its contacts
// turn one after the other from the base on.
TEST_F(CableContact, ContactsOfOneCableTurnOneAfterTheOther) {
  const Arm arm{.links = 10, .mass = 2e-3, .stiffness = 0.2, .bearings = {0}};
  const auto m = Model(arm.Mjcf("implicitfast"));
  const auto d = Data(m);
  while (d->time < 2) {
    d->ctrl[0] = d->time < 1 ? 6 * d->time : 6 - std::min(1.0, 2 * (d->time - 1));
    mj_step(m.get(), d.get());
  }
  const auto segments = Segments(m.get(), d.get(), 0, std::vector<double>(m->nv));
  double last = 1;
  for (int k = 2; k <= 10; ++k) {  // +1: turned, −1: as it was pulled
    const double part =
        std::log(d->sensordata[k] / d->sensordata[k - 1]) / (arm.mu * segments[k].theta);
    EXPECT_LE(part, last + 0.02) << k;
    last = part;
  }
  // The joints' damping helped to turn the first one: at rest it is less than fully turned.
  EXPECT_GT(std::log(d->sensordata[1] / d->ctrl[0]) / (arm.mu * segments[1].theta), 0.8);
  EXPECT_NEAR(last, -1, 0.02);
  EXPECT_LT(mju_norm(d->qvel, static_cast<int>(m->nv)), 1e-9);
}

TEST_F(CableContact, AnArmSwingsThroughStraight) {
  const Arm arm{.links = 10, .mass = 2e-3, .stiffness = 0.2};
  const auto swing = [&](double h) {
    const auto m = Model(arm.Mjcf("implicitfast"));
    m->opt.timestep = h;
    const auto d = Data(m);
    std::vector<double> angles;
    for (int half = 1; half <= 6; ++half) {
      while (d->time < 0.25 * half - 1e-9) {
        d->ctrl[0] = 3 + 2 * std::sin(2 * M_PI * d->time);
        d->ctrl[1] = 3 - 2 * std::sin(2 * M_PI * d->time);
        mj_step(m.get(), d.get());
      }
      double angle = 0;
      for (int i = 0; i < m->nv; ++i) angle += d->qpos[i];
      angles.push_back(angle);
    }
    return angles;
  };
  const auto coarse = swing(2e-3), fine = swing(1e-4);
  EXPECT_GT(fine[0], 0.5);
  EXPECT_LT(fine[2], -0.5);
  for (int k = 0; k < 6; ++k) EXPECT_NEAR(coarse[k], fine[k], 0.02 * fine[0]) << k;
}

}  // namespace
}  // namespace continuum
