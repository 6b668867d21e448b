// Robots that begin inside the ground, which MuJoCo's contacts throw out: friction adds nothing.
#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include "support/engine.h"

namespace continuum {
namespace {

enum class Kind { kNativeRows, kOurRows, kCable, kCableFriction };

class DeepContact : public testing::Engine {
 protected:
  // A floating chain of six links of 20 g, with a sprung cable or with dry friction of its joints.
  static testing::Owned<mjModel> Make(Kind kind) {
    constexpr int kLinks = 6;
    const bool cable = kind == Kind::kCable || kind == Kind::kCableFriction;
    std::string bodies, route, effect;
    for (int i = 0; i < kLinks; ++i) {
      const std::string name = std::to_string(i);
      bodies += "<body pos=\"" + std::string(i == 0 ? "0" : ".06") + " 0 0\"><joint name=\"j" +
                name + "\" axis=\"0 1 0\" stiffness=\".05\"" +
                (kind == Kind::kNativeRows ? " frictionloss=\".02\"" : "") +
                "/><geom type=\"capsule\" size=\".01\" fromto=\"0 0 0 .06 0 0\" mass=\".02\" "
                "condim=\"1\" contype=\"1\" conaffinity=\"2\"/><site name=\"s" +
                name + "\" pos=\".03 0 .02\"/>";
      route += "<site site=\"s" + name + "\"/>";
    }
    for (int i = 0; i < kLinks; ++i) bodies += "</body>";
    if (kind == Kind::kOurRows)
      effect = Instance("coulomb", Key("joint", "j*") + Key("tau_c", "0.02"));
    if (kind == Kind::kCableFriction)
      effect = Instance("capstan", Key("tendon", "t") + Key("mu", "0.3"));
    return Model(
        "<mujoco>" + effect +
        R"(<option timestep="5e-4" integrator="implicitfast"><flag energy="enable"/></option>
        <worldbody><geom type="plane" size="2 2 1" contype="2" conaffinity="1"/>
        <body><freejoint/><geom size=".01" mass=".02" contype="0" conaffinity="0"/>)" +
        bodies + "</body></worldbody>" +
        (cable ? "<tendon><spatial name=\"t\" stiffness=\"200\" springlength=\".2\">" + route +
                     "</spatial></tendon>"
               : "") +
        "</mujoco>");
  }

  // Energy [J] that the ground gives to the chain, from twelve poses: all that is above the
  // start's.
  static std::vector<double> Thrown(Kind kind) {
    const auto m = Make(kind);
    std::mt19937 random(1);
    const auto uniform = [&] { return double(random()) / double(std::mt19937::max()); };
    std::vector<double> thrown;
    for (int pose = 0; pose < 12; ++pose) {
      const auto d = Data(m);
      d->qpos[2] = 0.03 * uniform();
      for (int i = 7; i < m->nq; ++i) d->qpos[i] = 1.6 * uniform() - 0.8;
      mj_forward(m.get(), d.get());
      const double start = d->energy[0];
      double most = 0;
      while (d->time < 0.4) {
        mj_step(m.get(), d.get());
        most = std::max(most, d->energy[0] + d->energy[1] - start);
      }
      thrown.push_back(most);
    }
    return thrown;
  }
  static double Mean(const std::vector<double>& x) {
    double sum = 0;
    for (const double v : x) sum += v;
    return sum / double(x.size());
  }
};

TEST_F(DeepContact, GivesAsMuchWithOurRowsAsWithNativeOnes) {
  const auto native = Thrown(Kind::kNativeRows), ours = Thrown(Kind::kOurRows);
  ASSERT_GT(Mean(native), 0.05);
  // Native rows are softer and creep, which takes a little more.
  EXPECT_LT(Mean(ours), 1.1 * Mean(native));
}

TEST_F(DeepContact, GivesLessWithCableFrictionThanWithout) {
  const auto without = Thrown(Kind::kCable), with = Thrown(Kind::kCableFriction);
  ASSERT_GT(Mean(without), 0.05);
  EXPECT_LT(Mean(with), Mean(without));
}

}  // namespace
}  // namespace continuum
