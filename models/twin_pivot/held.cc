#include "models/twin_pivot/held.h"

#include <fmt/format.h>

#include <optional>
#include <utility>

#include "error.h"
#include "models/twin_pivot/cases.h"
#include "models/twin_pivot/details.h"
#include "models/twin_pivot/geometry.h"
#include "models/twin_pivot/twin_pivot.h"

namespace continuum::twin_pivot {
namespace {

class HeldArm : public statics::HeldRobot {
 public:
  HeldArm(Robot robot, Method method) : robot_(std::move(robot)), method_(method) {
    columns_ = statics::StateColumns();
    for (const char* axis : {"x", "y", "z"}) columns_.push_back(axis);
    for (auto& name : statics::DetailColumns{robot_.Cables()}.Names()) columns_.push_back(name);
    for (auto& name : statics::Numbered("beta_", robot_.Joints())) columns_.push_back(name);
    for (int m = 1; m <= robot_.Joints(); ++m) {
      for (const char* axis : {"x", "y", "z"}) columns_.push_back(fmt::format("{}_{}", axis, m));
    }
  }

  const std::vector<std::string>& columns() const override { return columns_; }

  statics::ResultRows Solve(const CsvTable& table, std::vector<std::string>& why) const override {
    statics::RefuseColumn(table, "reference");
    statics::RefuseColumn(table, "L1");
    const auto cases = ReadCases(table, robot_);
    statics::ResultRows results(cases.size(), columns_.size());
    std::vector<std::optional<Eigen::VectorXd>> beta(cases.size());
    why.assign(cases.size(), "");
    statics::ForNeighbours(cases.size(), [&](std::size_t i, bool fresh) {
      const Solution s =
          twin_pivot::Solve(robot_, cases[i].load, method_, fresh ? std::nullopt : beta[i - 1]);
      if (s.outcome.ok()) beta[i] = s.beta;
      why[i] = s.outcome.why;
      Write(cases[i].load, s, results.row(static_cast<Eigen::Index>(i)));
    });
    return results;
  }

 private:
  void Write(const Load& load, const Solution& s, Eigen::Ref<Eigen::RowVectorXd> row) const {
    statics::RowWriter writer(row);
    writer.Add(s.outcome, s.outcome.ok(), s.stability.branch);
    if (!s.outcome.ok()) return;
    writer.Add(s.tip);
    writer.Add(Describe(robot_, load, s));
    writer.Add(s.beta);
    const auto frames = DiscFrames(robot_, s.beta);
    for (std::size_t m = 1; m < frames.size(); ++m) writer.Add(frames[m].translation());
  }

  Robot robot_;
  Method method_;
  std::vector<std::string> columns_;
};

}  // namespace

std::unique_ptr<statics::HeldRobot> Hold(const std::filesystem::path& robot,
                                         const std::string& method) {
  return std::make_unique<HeldArm>(Robot::Read(robot), ParseMethod(method));
}

}  // namespace continuum::twin_pivot
