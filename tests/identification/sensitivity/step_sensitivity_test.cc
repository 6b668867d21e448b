// Sensitivities in closed form, of the differential equation and of MuJoCo's steps, against
// differences of both.
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "gradient.h"
#include "identification/problem/problem.h"
#include "identification/sensitivity/continuous_sensitivity.h"
#include "support/pendulum.h"

namespace continuum {
namespace {

using testing::Gradient;

// Three links with two cables and a lagged motor that can be switched off; friction: of every
// joint; lagged: further attributes of that motor.
std::string Arm(double friction, const std::string& integrator = "implicitfast",
                const std::string& lagged = "") {
  std::string bodies, close;
  for (int i = 0; i < 3; ++i) {
    bodies += fmt::format(
        "<body name='link{0}' pos='0 0 {1}'><joint name='x{0}' axis='1 0 0' stiffness='0.8' "
        "damping='0.02' armature='2e-4' frictionloss='{2}'/><joint name='y{0}' axis='0 1 0' "
        "stiffness='0.6' damping='0.015' frictionloss='{2}'/><inertial pos='0.003 0 -0.05' "
        "mass='0.1' diaginertia='1e-4 1.2e-4 4e-5'/><site name='a{0}' pos='0.03 0.01 -0.1'/>"
        "<site name='b{0}' pos='-0.01 0.03 -0.1'/>",
        i, i ? -0.1 : 0, friction);
    close += "</body>";
  }
  return fmt::format(
      "<mujoco><option timestep='2e-3' integrator='{}' tolerance='0' iterations='200'/>"
      "<worldbody><site name='a' pos='0.03 0.01 0'/><site name='b' pos='-0.01 0.03 0'/>{}{}"
      "</worldbody><tendon><spatial name='ta' damping='0.5'><site site='a'/><site site='a0'/>"
      "<site site='a1'/><site site='a2'/></spatial><spatial name='tb' stiffness='20'>"
      "<site site='b'/><site site='b0'/><site site='b1'/></spatial></tendon><actuator>"
      "<general name='pull' tendon='ta' gainprm='-1'/><general name='lagged' joint='y0' "
      "dyntype='filterexact' dynprm='0.04' gainprm='0.3' gear='1.5' actearly='true' {} "
      "biastype='affine' biasprm='0 0 -0.01'/></actuator><sensor><jointpos name='x0' joint='x0'/>"
      "<jointvel name='y2' joint='y2'/><framepos name='end' objtype='site' objname='a2'/>"
      "<framepos name='link' objtype='body' objname='link1'/></sensor></mujoco>",
      integrator, bodies, close, lagged);
}

constexpr char kParameters[] =
    "parameters:\n"
    "  - {name: k, target: 'joint:y*', attribute: stiffness, initial: 0.6, lower: 0.1, upper: 2}\n"
    "  - {name: b, target: 'joint:x*', attribute: damping, initial: 0.02, lower: 0, upper: 1}\n"
    "  - {name: ref, target: 'joint:x1', attribute: springref, initial: 0.1, lower: -1, upper: 1}\n"
    "  - {name: j, target: 'joint:y2', attribute: armature, initial: 1e-4, lower: 0, upper: 1e-2}\n"
    "  - {name: m, target: 'body:link1', attribute: mass, initial: 0.1, lower: 0.01, upper: 1}\n"
    "  - {name: c, target: 'body:link2', attribute: 'ipos[0]', initial: 0.003, lower: -1, upper: "
    "1}\n"
    "  - {name: g, target: 'actuator:pull', attribute: 'gainprm[0]', initial: -1, lower: -9, "
    "upper: 0}\n"
    "  - {name: T, target: 'actuator:lagged', attribute: 'dynprm[0]', initial: 0.04, lower: 0.01, "
    "upper: 1}\n"
    "  - {name: tk, target: 'tendon:tb', attribute: stiffness, initial: 20, lower: 1, upper: 90}\n"
    "  - {name: tb, target: 'tendon:ta', attribute: damping, initial: 0.5, lower: 0, upper: 9}\n"
    "  - {name: g0, target: option, attribute: 'gravity[0]', initial: 0.3, lower: -1, upper: 1}\n"
    "  - {name: site, target: 'site:a1', attribute: 'pos[0]', initial: 0.03, lower: 0, upper: "
    "0.1}\n"
    "  - {name: length, target: 'body:link1', attribute: 'pos[2]', initial: -0.1, lower: -0.2, "
    "upper: 0}\n"
    "  - {name: angle, target: 'body:link2', attribute: 'quat[3]', initial: 0.1, lower: -1, upper: "
    "1}\n"
    "  - {name: shift, target: 'sensor:x0', attribute: bias, initial: 0.01, lower: -1, upper: 1}\n";

class ClosedFormTest : public testing::Bench {
 protected:
  Experiment Read(double friction, const std::string& parameters, const std::string& start,
                  const std::string& integrator = "implicitfast", const std::string& lagged = "",
                  const std::string& sensors = "", const std::string& outputs = "") {
    std::string csv = "time,pull,swing,on,x0,y2,ex,ey,ez,lx,g0,g1,g2,a0,a1,a2,l0,l1,l2,u\n";
    for (int k = 0; k < 60; ++k) {
      csv += fmt::format("{:.4f},{},{:.6f},{},0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0\n", 0.0105 * k,
                         k < 5    ? 0
                         : k < 35 ? 6
                                  : 2,
                         0.3 * std::sin(0.4 * k), k < 20 || k > 30);
    }
    std::string model = Arm(friction, integrator, lagged);
    model.insert(model.find("</sensor>"), sensors);
    Write("log.csv", csv), Write("model.xml", model);
    return Experiment::Read(Write(
        "e.yaml", "format: 1\nmodel: model.xml\ntime: {column: time, unit: s}\nstart: " + start +
                      "\ninputs:\n"
                      "  - {column: pull, unit: N, actuator: pull, enable: on}\n"
                      "  - {column: swing, unit: N, actuator: lagged, interpolate: linear}\n"
                      "outputs:\n"
                      "  - {column: x0, unit: rad, sensor: x0, sigma: 1}\n"
                      "  - {column: y2, unit: rad/s, sensor: y2, sigma: 1}\n"
                      "  - {column: ex, unit: m, sensor: 'end[0]', sigma: 1}\n"
                      "  - {column: ey, unit: m, sensor: 'end[1]', sigma: 1}\n"
                      "  - {column: ez, unit: m, sensor: 'end[2]', sigma: 1}\n"
                      "  - {column: lx, unit: m, sensor: 'link[0]', sigma: 1}\n" +
                      outputs + "logs:\n  - {file: log.csv, use: train}\n" + parameters));
  }
};

// The largest error of any column in closed form, over that column's largest number.
std::string Errors(const Problem& problem, const Problem::Matrix& found,
                   const Problem::Matrix& expected, double most) {
  std::string wrong;
  for (Eigen::Index k = 0; k < expected.cols(); ++k) {
    const double size = expected.col(k).cwiseAbs().maxCoeff();
    const double error = (found.col(k) - expected.col(k)).cwiseAbs().maxCoeff() / size;
    if (!(error < most)) wrong += fmt::format("{} {:.2g}  ", problem.parameters()[k].name, error);
  }
  return wrong;
}

struct Steps {
  std::string name, start;
  double friction;
  std::string integrator = "implicitfast", lagged = "", parameters = "";
};
void PrintTo(const Steps& s, std::ostream* out) { *out << s.name; }

class ClosedFormStepsTest : public ClosedFormTest, public ::testing::WithParamInterface<Steps> {};

// Joints that rest are springs in the solver, and its friction is not smooth where they let go:
// differences narrower than the distance to that are rare events of rounding.
TEST_P(ClosedFormStepsTest, AreThoseOfMuJoCosSteps) {
  const Experiment e = Read(GetParam().friction, kParameters + GetParam().parameters,
                            GetParam().start, GetParam().integrator, GetParam().lagged);
  const ModelSpec system = ModelSpec::Load(e.model);
  const Problem problem(e, system);
  ASSERT_EQ(problem.NoClosedForm(), "");
  Problem differences(e, system);
  differences.DifferBy(1e-6);
  differences.Center();
  const auto use = problem.AllLogs();
  const auto x = problem.Start();
  const auto r = problem.Residuals(x, use);
  const std::size_t before = problem.evaluations();
  const auto J = problem.Jacobian(x, r, use)[0];
  EXPECT_EQ(problem.evaluations() - before, 2);  // all but a sensor's bias in one
  EXPECT_EQ(Errors(problem, J, differences.Jacobian(x, r, use)[0], 1e-5), "");
}

constexpr char kLate[] = "delay='0.0133' nsample='20' interp='linear'";
constexpr char kDelay[] =
    "  - {name: late, target: 'actuator:lagged', attribute: delay, initial: 0.0133, lower: 0.004, "
    "upper: 0.03}\n";

constexpr char kGear[] =
    "  - {name: motor, target: 'joint:y0', attribute: armature, initial: 2e-3, lower: 1e-4, upper: "
    "1e-2}\n"
    "  - {name: soft, target: 'joint:y0', attribute: 'effect:elastic_gear.c', initial: 0.05, "
    "lower: "
    "0.01, upper: 1}\n"
    "  - {name: loss, target: 'joint:y0', attribute: 'effect:elastic_gear.d', initial: 0.01, "
    "lower: "
    "0, upper: 1}\n"
    "  - {name: roll, target: 'body:link1', attribute: 'effect:mounting_angle.roll', initial: 0.1, "
    "lower: -1, upper: 1}\n"
    "  - {name: place, target: 'site:a1', attribute: 'effect:site_place.dy', initial: 0.01, lower: "
    "-1, upper: 1}\n"
    "  - {name: drum, target: 'actuator:pull', attribute: 'effect:drum_radius', initial: 1.1, "
    "lower: 0.5, upper: 2}\n";

INSTANTIATE_TEST_SUITE_P(
    Arm, ClosedFormStepsTest,
    ::testing::Values(Steps{"Smooth", "rest", 0}, Steps{"FromEquilibrium", "equilibrium", 0},
                      Steps{"Rubs", "rest", 0.02}, Steps{"ImplicitInMotion", "rest", 0, "implicit"},
                      Steps{"ImplicitInMotionRubs", "rest", 0.02, "implicit"},
                      Steps{"RungeKutta", "equilibrium", 0, "RK4"},
                      Steps{"RungeKuttaRubs", "rest", 0.02, "RK4"},
                      Steps{"GearAndGeometry", "rest", 0, "implicitfast", "", kGear},
                      Steps{"GearAndGeometryRub", "rest", 0.02, "RK4", "", kGear},
                      Steps{"Late", "rest", 0, "implicitfast", kLate, kDelay},
                      Steps{"LateRungeKutta", "rest", 0.02, "RK4", kLate, kDelay}),
    [](const auto& info) { return info.param.name; });

// Sensors without derivatives of their own, each held to its own size: accelerometers see forces.
class ClosedFormSensorsTest : public ClosedFormTest, public ::testing::WithParamInterface<Steps> {};

TEST_P(ClosedFormSensorsTest, AreThoseOfMuJoCosSteps) {
  std::string outputs;
  for (const char* const sensor : {"gyro", "acc", "load"}) {
    const char* const unit = sensor[0] == 'g' ? "rad/s" : sensor[0] == 'a' ? "m/s^2" : "N";
    for (int i = 0; i < 3; ++i)
      outputs += fmt::format("  - {{column: {0}{3}, unit: {1}, sensor: '{2}[{3}]', sigma: 1}}\n",
                             sensor[0], unit, sensor, i);
  }
  outputs += "  - {column: u, unit: N, actuator: lagged, quantity: force, sigma: 1}\n";
  const Experiment e = Read(GetParam().friction, kParameters, GetParam().start,
                            GetParam().integrator, GetParam().lagged,
                            "<gyro name='gyro' site='a2'/><accelerometer name='acc' site='a2'/>"
                            "<force name='load' site='a0'/>",
                            outputs);
  const ModelSpec system = ModelSpec::Load(e.model);
  const Problem problem(e, system);
  ASSERT_EQ(problem.NoClosedForm(), "");
  constexpr double kShare = 1e-6;
  Problem differences(e, system);
  differences.DifferBy(kShare);
  differences.Center();
  const auto use = problem.AllLogs();
  const auto x = problem.Start();
  const auto r = problem.Residuals(x, use);
  const std::size_t before = problem.evaluations();
  const auto found = problem.Jacobian(x, r, use)[0];
  EXPECT_EQ(problem.evaluations() - before, 2);
  const auto expected = differences.Jacobian(x, r, use)[0];
  const Eigen::Index rows = 60;
  for (Eigen::Index k = 0; k < expected.cols(); ++k) {
    const double step = std::abs(problem.StepOf(x, static_cast<std::size_t>(k), kShare));
    for (Eigen::Index at = 0; at < expected.rows(); at += rows) {
      const auto here = expected.col(k).segment(at, rows);
      const double size = here.cwiseAbs().maxCoeff(), rounding = 2e-12 / step;  // of the solver
      EXPECT_LT((found.col(k).segment(at, rows) - here).cwiseAbs().maxCoeff(),
                1e-5 * size + rounding)
          << problem.parameters()[k].name << " channel " << at / rows << " of size " << size;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Arm, ClosedFormSensorsTest,
                         ::testing::Values(Steps{"Smooth", "rest", 0},
                                           Steps{"FromEquilibrium", "equilibrium", 0},
                                           Steps{"Rubs", "rest", 0.02},
                                           Steps{"Implicit", "rest", 0, "implicit"},
                                           Steps{"RungeKutta", "equilibrium", 0, "RK4"}),
                         [](const auto& info) { return info.param.name; });

// The solver's own error, of 1e-8 of its cost, is no effect of a parameter.
TEST_F(ClosedFormTest, GivesNothingOfAParameterWithoutEffectWhereTheSolverEndsEarly) {
  const Experiment e = Read(0.02,
                            std::string(kParameters) +
                                "  - {name: idle, target: 'joint:x1', attribute: margin, initial: "
                                "0.01, lower: 0, upper: 1}\n",
                            "rest", "implicitfast", "", "<accelerometer name='acc' site='a2'/>",
                            "  - {column: a0, unit: m/s^2, sensor: 'acc[0]', sigma: 1}\n");
  std::string model = Arm(0.02);
  const std::string exact = " tolerance='0' iterations='200'";
  model.erase(model.find(exact), exact.size());
  model.insert(model.find("</sensor>"), "<accelerometer name='acc' site='a2'/>");
  const ModelSpec system = ModelSpec::Parse(model);
  const Problem problem(e, system);
  ASSERT_EQ(problem.NoClosedForm(), "");
  const auto x = problem.Start();
  const auto J = problem.Jacobian(x, problem.Residuals(x, problem.AllLogs()), problem.AllLogs());
  EXPECT_EQ(J[0].col(x.size() - 1).norm(), 0);
}

TEST_F(ClosedFormTest, FollowsAFrictionThatSlides) {
  const Experiment e = Read(0.02,
                            std::string(kParameters) +
                                "  - {name: f, target: 'joint:*', attribute: frictionloss, "
                                "initial: 0.02, lower: 0, upper: 1}\n",
                            "rest");
  const ModelSpec system = ModelSpec::Load(e.model);
  const Problem problem(e, system);
  Problem differences(e, system);
  differences.DifferBy(1e-6);
  differences.Center();
  const auto use = problem.AllLogs();
  const auto r = problem.Residuals(problem.Start(), use);
  EXPECT_EQ(Errors(problem, problem.Jacobian(problem.Start(), r, use)[0],
                   differences.Jacobian(problem.Start(), r, use)[0], 1e-5),
            "");
}

// What nobody can see in the model: the arm touches something on the way.
TEST_F(ClosedFormTest, LeavesALogWithAContactToDifferences) {
  Read(0, kParameters, "rest");
  std::string model = Arm(0);
  const std::string body = "<site name='a2'", wall = "<worldbody>";
  model.insert(model.find(body), "<geom size='0.01' pos='0 0 -0.1' mass='0'/>");
  model.insert(model.find(wall) + wall.size(),
               "<geom type='plane' pos='0 0.03 0' size='1 1 1' zaxis='0 -1 0'/>");
  Write("model.xml", model);
  const Experiment e = Experiment::Read(folder_ / "e.yaml");
  const ModelSpec system = ModelSpec::Load(e.model);
  const Problem problem(e, system);
  ASSERT_EQ(problem.NoClosedForm(), "");
  Problem differences(e, system);
  differences.DifferBy(1e-3);
  const auto use = problem.AllLogs();
  const auto r = problem.Residuals(problem.Start(), use);
  EXPECT_EQ(problem.Jacobian(problem.Start(), r, use)[0],
            differences.Jacobian(problem.Start(), r, use)[0]);
}

class ClosedFormFlowTest : public ClosedFormTest, public ::testing::WithParamInterface<Gradient> {};

TEST_P(ClosedFormFlowTest, AgreesWithTightCentralDifferences) {
  const Gradient& g = GetParam();
  const Experiment e = Read(0, "", "rest");
  const auto dynamics = testing::FlowBeside(e, g, 0);
  std::vector<std::unique_ptr<ContinuousDynamics>> perturbed;
  perturbed.push_back(testing::FlowBeside(e, g, kPerturbation));
  EXPECT_TRUE(ContinuousSensitivity(*dynamics, perturbed, kPerturbation).Covers(0));
  // The fast joint at the end needs runs as exact as they can be.
  const auto reference = testing::CentralDifferences(e, g, 1e-2, {1e-13, 1e-15, false});
  EXPECT_LT(testing::SlopeError(testing::Slopes(e, g), reference), 1e-5);
}

INSTANTIATE_TEST_SUITE_P(Attribute, ClosedFormFlowTest,
                         ::testing::Values(Gradient{"Mass", "body:link1", "mass", 0.1},
                                           Gradient{"Centre", "body:link2", "ipos[0]", 0.003},
                                           Gradient{"Stiffness", "joint:y*", "stiffness", 0.6},
                                           Gradient{"Damping", "joint:x*", "damping", 0.02},
                                           Gradient{"SpringRef", "joint:x1", "springref", 0.1},
                                           Gradient{"Armature", "joint:x*", "armature", 2e-4},
                                           Gradient{"Gear", "actuator:lagged", "gear", 1.5},
                                           Gradient{"Gain", "actuator:pull", "gainprm[0]", -1},
                                           Gradient{"Lag", "actuator:lagged", "dynprm[0]", 0.04},
                                           Gradient{"TendonStiffness", "tendon:tb", "stiffness",
                                                    20},
                                           Gradient{"TendonDamping", "tendon:ta", "damping", 0.5},
                                           Gradient{"Gravity", "option", "gravity[2]", -9.81}),
                         [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace continuum
