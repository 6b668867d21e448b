#pragma once

#include <array>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace continuum::twin_pivot {

/// Dead force [N] and moment [N m] on disc m at O_m, in the base frame.
struct DiscLoad {
  int disc = 0;  ///< 1..n
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
};

/// What the model counts (Tab 5): I no friction; II friction mu(theta); III friction mu_const; IV
/// friction mu(theta) but weights of discs only; V all, and the payload.
enum class Condition { kI, kII, kIII, kIV, kV };
constexpr std::array<const char*, 5> kConditions = {"I", "II", "III", "IV", "V"};

/// kVirtualWork: the balance that follows from virtual work, exact for the bent rods. kPrinted:
/// moments about the centre of the proximal disc as in (36), (40), for comparison only.
enum class Method { kVirtualWork, kPrinted };

/// @throws Error for another name than virtual_work (also when empty) and printed.
Method ParseMethod(const std::string& name);

struct Load {
  Condition condition = Condition::kV;
  std::vector<double> tension;  ///< F_SC of every cable at the base [N]
  /// Of cables that are driven by length: what is between the discs' faces without tension, from
  /// base to anchor [m]; then `tension` is not read. Empty: driven by tension.
  Eigen::VectorXd length;
  double payload = 0;                                ///< [kg] at O_n; counts in V only
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< at O_n, in the base frame [N]
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();  ///< in the base frame [N m]
  std::vector<DiscLoad> on_discs;                    ///< beside these
  Eigen::VectorXd disc_payload;             ///< [kg] at O_1..O_n, counts in V only; empty: none
  Eigen::Vector3d gravity = {0, -9.81, 0};  ///< in the base frame [m/s^2]
  /// l_ref [m], joints x cables: the state from which the cables started to slide; empty: straight.
  Eigen::MatrixXd reference;
  /// s of every contact in that state, -1..1, row m at disc m; empty: nothing has slid, 0.
  Eigen::MatrixXd slide;
};

}  // namespace continuum::twin_pivot
