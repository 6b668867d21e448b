#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "identification/problem/problem.h"
#include "support/pendulum.h"

namespace continuum {
namespace {

using ::testing::ElementsAre;

// Two links in the plane of x and z with a hinge each, and hinges across it that nothing bends.
class RestingJointsTest : public testing::Bench {
 protected:
  std::vector<std::string> Starts(const std::string& outputs, const std::string& gravity,
                                  const std::string& start = "") {
    Write("model.xml",
          "<mujoco><option timestep='0.002' gravity='" + gravity +
              "'/><worldbody><body><joint name='a' axis='0 1 0'/>"
              "<joint name='a_across' axis='1 0 0'/><geom type='capsule' size='0.01' fromto='0 0 0 "
              "0 0 -0.2' contype='0'/><body pos='0 0 -0.2'><joint name='b' axis='0 1 0'/>"
              "<joint name='b_across' axis='1 0 0'/><geom type='capsule' size='0.01' fromto='0 0 0 "
              "0 0 -0.2' contype='0'/><site name='tip' pos='0 0 -0.2'/></body></body></worldbody>"
              "<sensor><framepos name='tip' objtype='site' objname='tip'/></sensor></mujoco>");
    std::string csv = "time,x,y,z\n";
    for (int k = 0; k < 50; ++k) csv += Decimal(0.01 * k) + ",0.1,0,-0.3\n";
    Write("log.csv", csv);
    const Experiment e = Experiment::Read(
        Write("e.yaml", "format: 1\nmodel: model.xml\nstart: estimate\noutputs:\n" + outputs +
                            "logs:\n  - {file: log.csv" + start + "}\n"));
    const Problem problem(e, ModelSpec::Load(e.model));
    std::vector<std::string> names;
    for (const FreeParameter& p : problem.parameters())
      if (p.change.attribute == "position") names.push_back(p.change.target.substr(6));
    return names;
  }
};

const std::string kInPlane =
    "  - {column: x, unit: m, sensor: 'tip[0]'}\n  - {column: z, unit: m, sensor: 'tip[2]'}\n";

TEST_F(RestingJointsTest, AcrossThePlaneHaveNoStart) {
  EXPECT_THAT(Starts(kInPlane, "0 0 -9.81"), ElementsAre("a", "b"));
}

TEST_F(RestingJointsTest, HaveAStartWhereSomethingMeasuresOrMovesThem) {
  EXPECT_THAT(Starts(kInPlane + "  - {column: y, unit: m, sensor: 'tip[1]'}\n", "0 0 -9.81"),
              ElementsAre("a", "a_across", "b", "b_across"));
  EXPECT_THAT(Starts(kInPlane, "0 0.1 -9.81"), ElementsAre("a", "a_across", "b", "b_across"));
  EXPECT_THAT(Starts(kInPlane, "0 0 -9.81", ", start: {a_across: [0.1, 0]}"),
              ElementsAre("a", "a_across", "b", "b_across"));
}

}  // namespace
}  // namespace continuum
