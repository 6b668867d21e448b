#include "identification/problem/fitted_values.h"

#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "error.h"
#include "sim/io/json.h"

namespace continuum {
namespace {

// To a billionth of the scale, as a file rounds.
void RequireWithin(const std::filesystem::path& fit, const Problem& problem,
                   const Problem::Vector& x) {
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const FreeParameter& p = problem.parameters()[i];
    const double edge = 1e-9 * p.scale;
    if (p.lower - edge <= x[i] && x[i] <= p.upper + edge) continue;
    throw Error::Input(
        fit.string() + ": parameter '" + p.name + "'",
        fmt::format("a value within its bounds [{:g}, {:g}], {}", p.lower, p.upper, p.where),
        fmt::format("{:g}", x[i]));
  }
}

}  // namespace

Problem::Vector FittedValues(const std::filesystem::path& fit, const Problem& problem) {
  const nlohmann::json json = ReadJson(fit);
  Problem::Vector x = problem.Start();
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const std::string& name = problem.parameters()[i].name;
    bool found = false;
    try {
      for (const auto& p : json.at("parameters")) {
        if (p.at("name") == name) x[i] = p.at("value").get<double>(), found = true;
      }
    } catch (const nlohmann::json::exception& e) {
      throw Error::Input(fit.string(), "a fit.json", e.what());
    }
    if (!found) throw Error::Input(fit.string(), "a value of the parameter '" + name + "'", "none");
  }
  RequireWithin(fit, problem, x);
  return problem.Clamp(x);
}

}  // namespace continuum
