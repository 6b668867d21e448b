#include "models/tdcr/calibration_document.h"

#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "error.h"
#include "models/tdcr/document.h"

namespace continuum::tdcr {
namespace {

// Numbers of one name: one, or the components of a vector.
YAML::Node OneOrList(const Eigen::VectorXd& values) {
  return values.size() == 1 ? Number(values[0]) : List(values);
}

// Unknowns of one name: `count` of them from the first on.
struct Group {
  const Unknown& first;
  Eigen::Index at, count;
};

std::vector<Group> GroupsOf(const std::vector<Unknown>& unknowns) {
  std::vector<Group> groups;
  for (std::size_t i = 0; i < unknowns.size(); ++i) {
    if (i > 0 && unknowns[i].name == unknowns[i - 1].name) {
      ++groups.back().count;
    } else {
      groups.push_back({unknowns[i], static_cast<Eigen::Index>(i), 1});
    }
  }
  return groups;
}

/// Writes calibrated values into a copy of the robot's file.
class ValueWriter {
 public:
  ValueWriter(const Yaml& file, const Robot& robot, const std::string& source)
      : document_(YAML::Clone(file.node())), robot_(robot), source_(source) {}

  const YAML::Node& document() const { return document_; }

  // x, u: values and standard errors of the group as unknowns.
  void Write(const Group& group, const Eigen::VectorXd& x, const YAML::Node& standard) {
    const auto part = static_cast<std::size_t>(group.first.part);
    switch (group.first.quantity) {
      case Quantity::kMu:
        return Set(document_, "mu", Number(robot_.mu), standard);
      case Quantity::kBaseRotation:
        return Set(document_, "base_rotation", List(Eigen::VectorXd(robot_.base_rotation)),
                   standard);
      case Quantity::kAngle:
      case Quantity::kRadius:
        return WriteTendon(group.first, x[0], standard);
      default:
        break;
    }
    if (robot_.has_sections()) {
      YAML::Node section = document_["sections"][part];
      WriteSection(group.first, robot_.sections[part], section, standard);
    } else {
      WriteSegment(group.first, standard);
    }
  }

 private:
  void Set(YAML::Node node, const std::string& key, const YAML::Node& value,
           const YAML::Node& standard) {
    SetParameter(node, key, value, YAML::Clone(standard), source_);
  }

  void WriteSegment(const Unknown& u, const YAML::Node& standard) {
    switch (u.quantity) {
      case Quantity::kE:
        return Set(document_, "E", Number(robot_.E), standard);
      case Quantity::kGJ:
        return Set(document_, "nu", Number(robot_.nu), {});
      case Quantity::kDensity:
        return Set(document_, "density", Number(robot_.density), standard);
      case Quantity::kDiskMass:
        return Set(document_, "disk_mass", Number(robot_.disk_mass), standard);
      default:
        return Set(document_, "precurvature", List(Eigen::VectorXd(robot_.natural)), standard);
    }
  }

  void WriteSection(const Unknown& u, const Section& section, YAML::Node& node,
                    const YAML::Node& standard) {
    const bool material = section.E > 0;
    switch (u.quantity) {
      case Quantity::kE:
        if (material) return Set(node, "E", Number(section.E), standard);
        Set(node, "EI", Number(section.EI), standard);
        return Set(node, "GJ", Number(section.GJ), {});
      case Quantity::kGJ:
        if (material) return Set(node, "nu", Number(section.EI / section.GJ - 1), {});
        return Set(node, "GJ", Number(section.GJ), standard);
      case Quantity::kDensity:
        if (!material)
          return Set(node, "mass_per_length", Number(section.mass_per_length), standard);
        return Set(node, "density", Number(section.mass_per_length / section.area()), standard);
      case Quantity::kDiskMass:
        return Set(node, "disk_mass", Number(section.disk_mass), standard);
      default:
        return Set(node, "precurvature", List(Eigen::VectorXd(section.natural)), standard);
    }
  }

  // A number of the file, or every number of its list.
  static YAML::Node Each(const YAML::Node& given, double ratio, double sum) {
    const YAML::Node value = given.IsMap() ? given["value"] : given;
    if (!value.IsSequence()) return Number(value.as<double>() * ratio + sum);
    Eigen::VectorXd values(static_cast<Eigen::Index>(value.size()));
    for (std::size_t i = 0; i < value.size(); ++i) {
      values[static_cast<Eigen::Index>(i)] = value[i].as<double>() * ratio + sum;
    }
    return List(values);
  }

  void WriteTendon(const Unknown& u, double x, const YAML::Node& standard) {
    const bool angle = u.quantity == Quantity::kAngle;
    if (robot_.has_sections()) {
      YAML::Node tendon = document_["tendons"][static_cast<std::size_t>(u.part)];
      const char* const key = angle ? "angle" : "radius";
      return Set(tendon, key, Each(tendon[key], angle ? 1 : x, angle ? x : 0), standard);
    }
    if (!angle) return Set(document_, "tendon_radius", Number(robot_.tendon_radius), standard);
    const Eigen::VectorXd angles = Eigen::Map<const Eigen::VectorXd>(
        robot_.tendon_angles.data(), static_cast<Eigen::Index>(robot_.tendon_angles.size()));
    Set(document_, "tendon_angles", List(angles), {});
  }

  YAML::Node document_;
  const Robot& robot_;
  std::string source_;
};

// Low and high of every unknown of a group: a pair, or a list of pairs.
YAML::Node Interval(const Group& group, const Eigen::MatrixX2d& interval,
                    const Eigen::VectorXd& unit) {
  const auto pair = [&](Eigen::Index i) {
    return List(Eigen::VectorXd(unit[i] * interval.row(i).transpose()));
  };
  if (group.count == 1) return pair(group.at);
  YAML::Node list(YAML::NodeType::Sequence);
  for (Eigen::Index i = 0; i < group.count; ++i) list.push_back(pair(group.at + i));
  list.SetStyle(YAML::EmitterStyle::Flow);
  return list;
}

YAML::Node PredictionDocument(const Prediction& prediction) {
  YAML::Node node;
  node["level"] = Number(prediction.level);
  node["cases"] = prediction.cases;
  const auto& within = prediction.within;
  node["within"] = List(Eigen::VectorXd(
      Eigen::Map<const Eigen::VectorXd>(within.data(), static_cast<Eigen::Index>(within.size()))));
  return node;
}

}  // namespace

void AddExplained(const Explained& explained, bool poor, YAML::Node& node) {
  node["status"] = poor ? "poor" : "ok";
  node["rmse"] = Number(explained.rmse());
  node["deflection"] = Number(explained.deflection());
  node["scatter"] = Number(explained.scatter());
}

YAML::Node CalibrationDocument(const Yaml& file, const Robot& nominal, const std::string& method,
                               const Calibration& c, const std::string& source) {
  const auto count = static_cast<Eigen::Index>(c.unknowns.size());
  Eigen::VectorXd unit(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    unit[i] = UnitOf(c.unknowns[static_cast<std::size_t>(i)], nominal);
  }
  ValueWriter writer(file, c.robot, source);
  YAML::Node node, standard, shapes, model;
  node["method"] = method;
  node["cases"] = c.cases;
  for (const Group& group : GroupsOf(c.unknowns)) {
    const std::string& name = group.first.name;
    const auto of = [&](const Eigen::VectorXd& values) {
      return Eigen::VectorXd(
          values.segment(group.at, group.count).cwiseProduct(unit.segment(group.at, group.count)));
    };
    standard[name] = OneOrList(of(c.spread.standard));
    node[name] = OneOrList(of(c.x));
    shapes[name] = Interval(group, c.spread.shapes, unit);
    model[name] = Interval(group, c.spread.model, unit);
    writer.Write(group, c.x.segment(group.at, group.count), standard[name]);
  }
  node["standard_error"] = standard;
  node["interval_of_shapes"] = shapes;
  node["interval_with_model_error"] = model;
  node["at_bound"] = List(c.at_bound);
  AddExplained(c.explained, c.explained.poor(), node);
  node["tip_error_percent"] = Document(c.tips);
  node["prediction"] = PredictionDocument(c.prediction);
  YAML::Node document = writer.document();
  document["calibration"] = node;
  return document;
}

std::optional<Prediction> ReadPrediction(const Yaml& file, const Robot& robot) {
  const auto calibration = file.Find("calibration");
  const auto node = calibration ? calibration->Find("prediction") : std::nullopt;
  if (!node) return std::nullopt;
  Prediction prediction;
  prediction.level = node->At("level").Number(0, 1);
  prediction.cases = node->At("cases").Integer();
  for (const Yaml& within : node->At("within").Items()) {
    const bool none = within.node().IsNull();
    prediction.within.push_back(none ? std::numeric_limits<double>::quiet_NaN()
                                     : within.Number(0, 1e9));
  }
  if (static_cast<int>(prediction.within.size()) == robot.disks) return prediction;
  throw Error::Input(node->At("within").Where(), fmt::format("{} distances", robot.disks),
                     fmt::format("{}", prediction.within.size()));
}

}  // namespace continuum::tdcr
