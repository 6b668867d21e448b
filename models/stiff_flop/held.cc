#include "models/stiff_flop/held.h"

#include <utility>

#include "error.h"
#include "models/stiff_flop/details.h"
#include "models/stiff_flop/forward.h"
#include "models/stiff_flop/inverse.h"

namespace continuum::stiff_flop {
namespace {

class HeldModules : public statics::HeldRobot {
 public:
  HeldModules(Robot robot, Method method, Direction direction)
      : robot_(std::move(robot)), method_(method), direction_(direction) {
    columns_ = statics::StateColumns();
    for (const char* name : {"x", "y", "z", "tx", "ty", "tz"}) columns_.push_back(name);
    const std::vector<std::string> answer =
        direction == Direction::kForward
            ? std::vector<std::string>{"kappa", "phi", "lambda_l"}
            : statics::Numbered("p", static_cast<int>(robot_.series.lines()));
    columns_.insert(columns_.end(), answer.begin(), answer.end());
    for (auto& name : statics::DetailColumns{}.Names()) columns_.push_back(name);
  }

  const std::vector<std::string>& columns() const override { return columns_; }

  statics::ResultRows Solve(const CsvTable& table, std::vector<std::string>& why) const override {
    const Cases cases = Cases::Read(table, robot_);
    if (cases.direction != direction_) {
      throw Error::Input(table.name(), direction_ == Direction::kForward
                                           ? "columns p1, p2, .. expected"
                                           : "columns kappa, phi, lambda_l expected");
    }
    statics::ResultRows results(cases.rows.size(), columns_.size());
    why.assign(cases.rows.size(), "");
    statics::ForNeighbours(cases.rows.size(), [&](std::size_t i, bool) {
      const Solution s = SolveOne(cases.rows[i]);
      why[i] = s.outcome.why;
      Write(cases.rows[i], s, results.row(static_cast<Eigen::Index>(i)));
    });
    return results;
  }

 private:
  Solution SolveOne(const Case& row) const {
    return direction_ == Direction::kForward ? SolveForward(robot_.series, method_, row, false)
                                             : SolveInverse(robot_.module(), method_, row, false);
  }
  void Write(const Case& row, const Solution& s, Eigen::Ref<Eigen::RowVectorXd> numbers) const {
    const bool ok = s.status == Status::kOk && s.stability.stable();
    statics::RowWriter writer(numbers);
    writer.Add(s.outcome, ok, s.stability.branch);
    if (!ok) return;
    writer.Add(s.tip);
    writer.Add(s.tangent);
    writer.Add(s.answer);
    writer.Add(Describe(robot_.series, method_, direction_, row, s));
  }

  Robot robot_;
  Method method_;
  Direction direction_;
  std::vector<std::string> columns_;
};

}  // namespace

std::unique_ptr<statics::HeldRobot> Hold(const std::filesystem::path& file,
                                         const std::string& method, bool inverse) {
  const Direction direction = inverse ? Direction::kInverse : Direction::kForward;
  Robot robot = Robot::Read(file);
  if (inverse) robot.RequireOne("shapes to pressures");
  return std::make_unique<HeldModules>(std::move(robot), Method::Parse(method, direction),
                                       direction);
}

}  // namespace continuum::stiff_flop
