// Rows of the constraint solver, against what MuJoCo makes of them.
#include "binding/row_impedance.h"

#include <string>
#include <vector>

#include "support/engine.h"

namespace continuum {
namespace {

class RowImpedanceTest : public testing::Engine {};

TEST_F(RowImpedanceTest, IsThatOfMujoco) {
  const std::vector<std::string> references{"0.02 1", "0.001 1", "0.1 0.3", "-900 -20"};
  const std::vector<std::string> impedances{"0.9 0.95 0.001 0.5 2", "0.1 0.99 0.01 0.3 1",
                                            "0.3 0.7 0.02 0.8 3", "0.8 0.8 0.01 0.5 2",
                                            "0 1 0 0.5 2"};
  for (const std::string& reference : references) {
    for (const std::string& impedance : impedances) {
      const std::string limit = "solreflimit='" + reference + "' solimplimit='" + impedance + "'",
                        other = "solref='" + reference + "' solimp='" + impedance + "'";
      const auto m = Model(
          "<mujoco><option timestep='2e-3'/><worldbody><geom type='plane' size='1 1 1' " + other +
          "/><body pos='0 0 .095'><freejoint/><geom size='.1' " + other +
          "/><site name='a'/></body><site name='b' pos='.3 0 1'/><body pos='1 0 1'><joint "
          "name='j'/>"
          "<geom size='.1'/></body></worldbody><tendon><spatial name='t' range='0 .946' "
          "limited='true' " +
          limit +
          "><site site='a'/><site site='b'/></spatial><fixed name='f'><joint joint='j' coef='1'/>"
          "</fixed></tendon><equality><tendon tendon1='f' polycoef='.004' " +
          other + "/></equality></mujoco>");
      const auto d = Data(m);
      mj_forward(m.get(), d.get());
      ASSERT_GE(d->nefc, 5);  // the equality, the limit and a contact
      for (int r = 0; r < d->nefc; ++r) {
        const RowImpedance row = RowImpedanceOf(*m, *d, r);
        const std::string what = "row " + std::to_string(r) + ", " + reference + ", " + impedance;
        EXPECT_NEAR(row.stiffness, d->efc_KBIP[4 * r], 1e-12 * row.stiffness) << what;
        EXPECT_NEAR(row.damping, d->efc_KBIP[4 * r + 1], 1e-12 * row.damping) << what;
        EXPECT_NEAR(row.value, d->efc_KBIP[4 * r + 2], 1e-12) << what;
      }
    }
  }
}

}  // namespace
}  // namespace continuum
