#include "sim/replay/sensor_score.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <nlohmann/json.hpp>

#include "sim/simulation/score.h"

namespace continuum {
namespace {

// Channels that belong together.
struct Source {
  std::string name, quantity, unit;
  double factor;
  bool turn;
  std::vector<std::size_t> channels;
};

const char* QuantityOf(const Output& out) {
  return out.kind == Output::Kind::kForce     ? "force"
         : out.kind == Output::Kind::kControl ? "control"
                                              : "";
}

std::vector<Source> SourcesOf(const Experiment& e) {
  std::vector<Source> sources;
  std::set<std::string> mixed;
  for (std::size_t c = 0; c < e.channels.size(); ++c) {
    const auto& channel = e.channels[c];
    const Output& out = e.outputs[channel.output];
    const std::string name = out.source.substr(0, out.source.find('['));
    const std::string quantity = QuantityOf(out);
    const auto known = std::find_if(sources.begin(), sources.end(), [&](const Source& s) {
      return s.name == name && s.quantity == quantity;
    });
    if (known == sources.end()) {
      const bool turn = out.quaternion();
      sources.push_back(
          {name, quantity, turn ? "rad" : channel.unit, turn ? 1 : channel.factor, turn, {c}});
      continue;
    }
    known->channels.push_back(c);
    if (!known->turn && known->unit != channel.unit) mixed.insert(name);
  }
  std::erase_if(sources, [&](const Source& s) { return mixed.contains(s.name); });
  return sources;
}

struct Sums {
  std::size_t rows = 0;
  double errors = 0, squares = 0, measured = 0;

  void Add(const Source& source, const Log& log,
           const std::vector<std::vector<double>>& residuals) {
    for (std::size_t row = 0; row < log.rows(); ++row) {
      double error = 0, size = 0;
      for (const std::size_t c : source.channels) {
        error += std::pow(residuals[c][row] / source.factor, 2);
        size += std::pow(log.measured[c][row] / source.factor, 2);
      }
      if (std::isnan(error)) continue;
      ++rows;
      errors += std::sqrt(error), squares += error, measured += size;
    }
  }
};

// Logs that are scored together.
struct Group {
  std::string use, condition;  // empty: any

  bool Holds(const Log& log) const {
    return (use.empty() || (use == "train") == log.train) &&
           (condition.empty() || condition == log.condition);
  }
};

std::vector<Group> GroupsOf(const Experiment& e) {
  std::set<std::string> uses, conditions;
  for (const Log& log : e.logs) {
    uses.insert(log.train ? "train" : "validate");
    conditions.insert(log.condition);
  }
  if (uses.size() > 1) uses.insert("");
  if (conditions.size() == 1) conditions.clear();
  conditions.insert("");
  std::vector<Group> groups;
  for (const std::string& use : uses) {
    for (const std::string& condition : conditions) groups.push_back({use, condition});
  }
  return groups;
}

SensorScore ScoreOf(const Source& source, const Group& group, const Sums& sums) {
  const auto n = static_cast<double>(sums.rows);
  const double relative =
      !source.turn && sums.measured > 0 ? std::sqrt(sums.squares / sums.measured) : 0;
  return {source.name,
          source.quantity,
          group.use,
          group.condition,
          source.unit,
          sums.rows,
          std::sqrt(sums.squares / n),
          sums.errors / n,
          relative};
}

}  // namespace

std::vector<SensorScore> ScoreSensors(const Experiment& e, const std::vector<Replayed>& logs) {
  std::vector<std::vector<std::vector<double>>> residuals;
  for (std::size_t l = 0; l < logs.size(); ++l)
    residuals.push_back(Residuals(e, e.logs[l], logs[l].trace));
  std::vector<SensorScore> scores;
  for (const Source& source : SourcesOf(e)) {
    for (const Group& group : GroupsOf(e)) {
      Sums sums;
      for (std::size_t l = 0; l < logs.size(); ++l) {
        if (group.Holds(e.logs[l])) sums.Add(source, e.logs[l], residuals[l]);
      }
      if (sums.rows > 0) scores.push_back(ScoreOf(source, group, sums));
    }
  }
  return scores;
}

nlohmann::json ToJson(const std::vector<SensorScore>& scores) {
  auto list = nlohmann::json::array();
  for (const SensorScore& s : scores) {
    list.push_back({{"source", s.source},
                    {"quantity", s.quantity},
                    {"use", s.use},
                    {"condition", s.condition},
                    {"unit", s.unit},
                    {"rows", s.rows},
                    {"rms", s.rms},
                    {"mean", s.mean},
                    {"relative", s.relative}});
  }
  return list;
}

}  // namespace continuum
