// The generator for arms of other sections than the paper's.
#include <cmath>
#include <numbers>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "error.h"
#include "models/annelida/annelida.h"
#include "sim/io/file.h"
#include "sim/model/model_spec.h"
#include "support/scratch.h"

namespace continuum {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

const std::string kYaml = std::string(CONTINUUM_SOURCE) + "/models/annelida/annelida.yaml";

AnnelidaParameters With(const std::string& lines) {
  const testing::Scratch scratch;
  return ReadAnnelida(scratch.Write("arm.yaml", ReadFile(kYaml) + lines));
}

TEST(AnnelidaSections, FiveModulesInOneSectionAreThePapersArm) {
  EXPECT_EQ(AnnelidaMjcf(With("sections: [5]\n")), AnnelidaMjcf(ReadAnnelida(kYaml)));
}

TEST(AnnelidaSections, CablesEndWhereTheirSectionEnds) {
  const AnnelidaParameters p = With("sections: [3, 4]\n");
  const ModelSpec arm = ModelSpec::Parse(AnnelidaMjcf(p));
  const mjModel& m = arm.model();
  EXPECT_EQ(m.nu, 8);
  EXPECT_EQ(m.nv, 14);
  for (int j = 0; j < 8; ++j) {
    const int links = j < 4 ? 3 : 7;
    ASSERT_EQ(m.tendon_num[j], 2 + 2 * links);
    const int end = m.wrap_objid[m.tendon_adr[j] + m.tendon_num[j] - 1];
    EXPECT_EQ(m.names + m.name_bodyadr[m.site_bodyid[end]], "link" + std::to_string(links));
    const double azimuth = std::atan2(m.site_pos[3 * end + 1], m.site_pos[3 * end]);
    const double due = std::numbers::pi / 2 * (j % 4 + 0.5 * (j / 4));
    EXPECT_NEAR(std::remainder(azimuth - due, 2 * std::numbers::pi), 0, 1e-12);
  }
  EXPECT_NEAR(m.body_subtreemass[0], 6 * p.m + p.m_last, 1e-12);
}

// n equal discs on springs: ω_k = 2 sqrt(K_t/I) sin((2k − 1) π/(2 (2n + 1))).
TEST(AnnelidaSections, TorsionSwingsAtTheRatesOfAChainOfDiscs) {
  AnnelidaParameters p = With("sections: [6]\nK_t: 2.0\n");
  p.I_last = p.I;
  p.gravity = p.tau_mu = p.tau_c = p.mu = 0;
  const ModelAndData machine = ModelSpec::Parse(AnnelidaMjcf(p)).Build();
  mjModel& m = *machine.model;
  mjData& d = *machine.data;
  m.opt.timestep = 1e-4;
  m.opt.integrator = mjINT_RK4;
  const double rate = 2 * std::sqrt(2.0 / p.I) * std::sin(std::numbers::pi / (2 * 13));
  // Of the first mode: disc i turns by sin(i π/13), so its joint by the difference.
  const auto shape = [](int i) { return std::sin(i * std::numbers::pi / 13); };
  for (int i = 1; i <= 6; ++i) {
    const int joint = mj_name2id(&m, mjOBJ_JOINT, ("twist" + std::to_string(i)).c_str());
    ASSERT_GE(joint, 0);
    d.qpos[m.jnt_qposadr[joint]] = 1e-3 * (shape(i) - shape(i - 1));
  }
  mj_forward(&m, &d);
  const std::vector<double> start(d.qpos, d.qpos + m.nq);
  const double period = 2 * std::numbers::pi / rate;
  while (d.time < period - 0.5e-4) mj_step(&m, &d);
  const double phase = rate * d.time;
  for (int k = 0; k < m.nq; ++k) EXPECT_NEAR(d.qpos[k], start[k] * std::cos(phase), 1e-9);
}

TEST(AnnelidaSections, RefusesWhatIsNoArm) {
  EXPECT_THAT([] { With("sections: [3, 0]\n"); },
              ThrowsMessage<Error>(AllOf(HasSubstr("arm.yaml:"), HasSubstr("sections[1]"),
                                         HasSubstr("at least 1"), HasSubstr("'0'"))));
  EXPECT_THAT([] { With("sections: []\n"); },
              ThrowsMessage<Error>(AllOf(HasSubstr("sections"), HasSubstr("an empty list"))));
  EXPECT_THAT([] { With("sections: 5\n"); }, ThrowsMessage<Error>(HasSubstr("sections")));
  EXPECT_THAT([] { With("d_t: 0.1\n"); },
              ThrowsMessage<Error>(AllOf(HasSubstr("d_t"), HasSubstr("K_t"))));
  EXPECT_THAT([] { With("K_t: -2\n"); }, ThrowsMessage<Error>(HasSubstr("K_t")));
}

}  // namespace
}  // namespace continuum
