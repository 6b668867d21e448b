#include "models/tdcr/held.h"

#include <fmt/format.h>

#include "error.h"
#include "models/tdcr/columns.h"
#include "models/tdcr/details.h"
#include "models/tdcr/equilibrium.h"
#include "models/tdcr/inputs.h"
#include "models/tdcr/model.h"
#include "sim/io/yaml.h"

namespace continuum::tdcr {
namespace {

class HeldRod : public statics::HeldRobot {
 public:
  HeldRod(Robot robot, Method method) : robot_(std::move(robot)), method_(method) {
    columns_ = statics::StateColumns();
    for (const char* axis : {"x", "y", "z"}) columns_.push_back(axis);
    for (auto& name : statics::DetailColumns{robot_.tendons}.Names()) columns_.push_back(name);
    for (int i = 1; i <= robot_.disks; ++i) {
      for (const char* axis : {"x", "y", "z"}) columns_.push_back(fmt::format("{}_{}", axis, i));
    }
  }

  const std::vector<std::string>& columns() const override { return columns_; }

  statics::ResultRows Solve(const CsvTable& table, std::vector<std::string>& why) const override {
    statics::RefuseColumn(table, "reference");
    statics::RefuseColumn(table, "L1");
    const auto cases = ReadCases(table, robot_);
    for (const Case& c : cases) RequireTaken(robot_, c.loads, method_);
    statics::ResultRows results(cases.size(), columns_.size());
    std::vector<Eigen::VectorXd> x(cases.size());
    why.assign(cases.size(), "");
    statics::ForNeighbours(cases.size(), [&](std::size_t i, bool fresh) {
      const Loads& loads = cases[i].loads;
      const bool warm =
          !fresh && x[i - 1].size() > 0 && !loads.AsItSlides() && OneEquilibrium(robot_, loads);
      const Solution s = SolveCase(robot_, loads, method_, warm ? &x[i - 1] : nullptr);
      if (s.outcome.ok()) x[i] = s.x;
      why[i] = s.outcome.why;
      Write(loads, s, results.row(static_cast<Eigen::Index>(i)));
    });
    return results;
  }

 private:
  void Write(const Loads& loads, const Solution& s, Eigen::Ref<Eigen::RowVectorXd> row) const {
    statics::RowWriter writer(row);
    writer.Add(s.outcome, s.outcome.ok(), s.stability.branch);
    if (!s.outcome.ok()) return;
    writer.Add(s.disks.rightCols<1>());
    writer.Add(Describe(robot_, loads, method_, s));
    writer.Add(s.disks);
  }

  Robot robot_;
  Method method_;
  std::vector<std::string> columns_;
};

}  // namespace

std::unique_ptr<statics::HeldRobot> Hold(const std::filesystem::path& file,
                                         const std::string& method) {
  const Yaml yaml = Yaml::Read(file);
  Robot robot = ReadRobot(yaml);
  RequireKnownKeys(yaml);
  SolveRequest request;
  request.method = method;
  const Method parsed = ParseMethod(MethodName(request, robot));
  return std::make_unique<HeldRod>(std::move(robot), parsed);
}

}  // namespace continuum::tdcr
