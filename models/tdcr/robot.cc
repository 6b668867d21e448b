#include "models/tdcr/robot.h"

#include <algorithm>

#include "error.h"
#include "models/statics/columns.h"
#include "models/tdcr/columns.h"
#include "models/tdcr/read_sections.h"
#include "sim/io/decimal.h"

namespace continuum::tdcr {
namespace {

// A value of the robot's file with the word for its range.
double Positive(const Yaml& file, const std::string& key) {
  const Yaml node = file.At(key);
  const double value = node.Parameter();
  if (value > 0) return value;
  throw Error::Input(node.Where(), "a number above 0", Decimal(value));
}

double NotNegative(const Yaml& file, const std::string& key) {
  const Yaml node = file.At(key);
  const double value = node.Parameter();
  if (value >= 0) return value;
  throw Error::Input(node.Where(), "a number of at least 0", Decimal(value));
}

int Count(const Yaml& file, const std::string& key, int least, int most) {
  const Yaml node = file.At(key);
  const double value = node.Parameter();
  if (value >= least && value <= most && value == std::floor(value)) return static_cast<int>(value);
  throw Error::Input(node.Where(),
                     "a whole number from " + std::to_string(least) + " to " + std::to_string(most),
                     Decimal(value));
}

Eigen::Vector3d Vector(const Yaml& node) {
  const auto values = node.Parameters();
  if (values.size() == 3) return {values[0], values[1], values[2]};
  throw Error::Input(node.Where(), "three numbers", std::to_string(values.size()));
}

Eigen::Vector3d Gravity(const Yaml& node) {
  if (node.Quantity().IsList()) return Vector(node);
  if (node.Parameter() == 0) return Eigen::Vector3d::Zero();
  throw Error::Input(node.Where(), "three numbers or 0", Decimal(node.Parameter()));
}

double Friction(double mu, const std::string& where) {
  if (mu >= 0 && mu < 1) return mu;
  throw Error::Input(where, "0 <= mu < 1", Decimal(mu));
}

int Direction(const CsvTable& table, std::size_t row, const std::string& column) {
  if (table.Text(row, column) == "auto") return kAsItSlides;
  const double value = table.Number(row, column);
  if (value == 1 || value == 0 || value == -1) return static_cast<int>(value);
  throw Error::Input(table.Where(row) + ", column '" + column + "'",
                     "1 (pulled), -1 (released), 0 (without friction) or auto", Decimal(value));
}

// The last of the rows before this one that has the name in column `reference`.
int Reference(const CsvTable& table, std::size_t row, const std::vector<Case>& cases) {
  if (!table.Has("reference") || table.Text(row, "reference").empty()) return -1;
  const std::string& name = table.Text(row, "reference");
  for (std::size_t earlier = row; earlier-- > 0;) {
    if (cases[earlier].name == name) return static_cast<int>(earlier);
  }
  throw Error::Input(table.Where(row) + ", column 'reference'", "the case of an earlier row",
                     "'" + name + "'");
}

// A tension or a length.
double ReadDrive(const CsvTable& table, std::size_t row, const std::string& column) {
  const double value = table.Number(row, column);
  const bool length = column[0] == 'L';
  if (length ? value > 0 : value >= 0) return value;
  throw Error::Input(table.Where(row) + ", column '" + column + "'",
                     length ? "a length above 0" : "a tension of at least 0", Decimal(value));
}

}  // namespace

bool HasVector(const CsvTable& table, const std::vector<std::string>& columns) {
  const auto has = [&](const std::string& column) { return table.Has(column); };
  if (std::none_of(columns.begin(), columns.end(), has)) return false;
  statics::RequireColumns(table, columns);
  return true;
}

double Robot::AngleOf(int tendon) const {
  if (!tendon_angles.empty()) return tendon_angles[static_cast<std::size_t>(tendon)];
  return 2 * std::numbers::pi * tendon / tendons;
}

void Robot::SpreadTendons() {
  if (!tendon_angles.empty()) return;
  for (int k = 0; k < tendons; ++k) tendon_angles.push_back(2 * std::numbers::pi * k / tendons);
}

Eigen::Vector2d Robot::Hole(int tendon) const {
  const double sigma = AngleOf(tendon);
  return {tendon_radius * std::cos(sigma), tendon_radius * std::sin(sigma)};
}

std::vector<Section> Robot::Sections() const {
  if (has_sections()) return sections;
  Section whole;
  whole.diameter = diameter;
  whole.E = E;
  whole.EI = EI();
  whole.GJ = GJ();
  whole.mass_per_length = density * area();
  whole.disk_mass = disk_mass;
  whole.natural = natural;
  for (int i = 1; i <= disks; ++i) whole.disks.push_back(i * length / disks);
  return {whole};
}

Route Robot::RouteOf(int tendon) const {
  if (has_sections()) return routes[static_cast<std::size_t>(tendon)];
  const auto places = static_cast<std::size_t>(disks) + 1;
  return {std::vector<double>(places, tendon_radius), std::vector<double>(places, AngleOf(tendon))};
}

double Robot::Place(int disk) const {
  if (!has_sections()) return disk * length / disks;
  double start = 0;
  auto rest = static_cast<std::size_t>(disk);
  for (const Section& s : sections) {
    if (rest == 0) break;
    if (rest <= s.disks.size()) return start + s.disks[rest - 1];
    rest -= s.disks.size();
    start += s.length();
  }
  return start;
}

double Robot::mass() const {
  if (!has_sections()) return disks * disk_mass + density * area() * length;
  double sum = 0;
  for (const Section& s : sections) {
    sum += s.mass_per_length * s.length() + static_cast<double>(s.disks.size()) * s.disk_mass;
  }
  return sum;
}

double Robot::Softest() const {
  double softest = EI();
  for (const Section& s : sections) softest = std::min(softest, s.Softest());
  return softest;
}

Eigen::Matrix3d Robot::MeasuringToBase() const {
  const double cx = std::cos(base_rotation.x()), sx = std::sin(base_rotation.x());
  const double cy = std::cos(base_rotation.y()), sy = std::sin(base_rotation.y());
  const double cz = std::cos(base_rotation.z()), sz = std::sin(base_rotation.z());
  Eigen::Matrix3d x, y, z;
  x << 1, 0, 0, 0, cx, -sx, 0, sx, cx;
  y << cy, 0, sy, 0, 1, 0, -sy, 0, cy;
  z << cz, -sz, 0, sz, cz, 0, 0, 0, 1;
  return x * y * z;
}

Loads Loads::Scaled(double load) const {
  Loads scaled = *this;
  for (double& t : scaled.tension) t *= load;
  scaled.tip_force *= load;
  scaled.disk_force *= load;
  scaled.disk_moment *= load;
  scaled.gravity *= load;
  return scaled;
}

bool SomeRest(const Contacts& contacts) {
  constexpr double kSlides = 0.999;
  const auto share = contacts.share.array().abs();
  return (share > 0 && share < kSlides).any();
}

bool Loads::AsItSlides() const {
  return std::find(direction.begin(), direction.end(), kAsItSlides) != direction.end();
}

double Loads::DeadForce(const Robot& robot) const {
  return tip_force.norm() + robot.mass() * gravity.norm() + disk_force.colwise().norm().sum() +
         disk_moment.colwise().norm().sum() / robot.length;
}

Loads NoLoads(const Robot& robot) {
  Loads loads;
  loads.tension.assign(static_cast<std::size_t>(robot.tendons), 0);
  loads.direction.assign(static_cast<std::size_t>(robot.tendons), 1);
  loads.gravity = robot.gravity;
  loads.mu = robot.mu;
  return loads;
}

namespace {

// A robot of sections, and its sizes.
void ReadArm(const Yaml& file, Robot& robot) {
  robot.sections = ReadSections(file);
  robot.routes = ReadRoutes(file, robot.sections);
  robot.tendons = static_cast<int>(robot.routes.size());
  robot.length = robot.diameter = robot.tendon_radius = 0;
  robot.disks = 0;
  for (const Section& s : robot.sections) {
    robot.length += s.length();
    robot.disks += static_cast<int>(s.disks.size());
    robot.diameter = std::max(robot.diameter, s.diameter);
  }
  for (const Route& r : robot.routes) {
    const double widest = *std::max_element(r.radius.begin(), r.radius.end());
    robot.tendon_radius = std::max(robot.tendon_radius, widest);
  }
}

// The segment of the paper.
void ReadSegment(const Yaml& file, Robot& robot) {
  robot.length = Positive(file, "length");
  robot.diameter = Positive(file, "diameter");
  robot.disks = Count(file, "disks", 2, 1000);
  robot.tendons = Count(file, "tendons", 1, kMaxTendons);
  robot.tendon_radius = Positive(file, "tendon_radius");
  robot.E = Positive(file, "E");
  robot.nu = file.At("nu").Parameter();
  if (!(robot.nu > -1 && robot.nu <= 0.5)) {
    throw Error::Input(file.At("nu").Where(), "-1 < nu <= 0.5", Decimal(robot.nu));
  }
  robot.density = NotNegative(file, "density");
  robot.disk_mass = NotNegative(file, "disk_mass");
  if (const auto node = file.Find("precurvature")) robot.natural = Vector(*node);
  if (const auto node = file.Find("tendon_angles")) {
    robot.tendon_angles = node->Parameters();
    if (static_cast<int>(robot.tendon_angles.size()) != robot.tendons) {
      throw Error::Input(node->Where(), std::to_string(robot.tendons) + " angles",
                         std::to_string(robot.tendon_angles.size()));
    }
  }
}

}  // namespace

Robot ReadRobot(const Yaml& file) {
  Robot robot;
  if (const int format = file.At("format").Integer(); format != 1) {
    throw Error::Input(file.At("format").Where(), "format 1", std::to_string(format));
  }
  if (file.Has("sections")) {
    ReadArm(file, robot);
  } else {
    ReadSegment(file, robot);
  }
  robot.mu = Friction(file.At("mu").Parameter(), file.At("mu").Where());
  if (file.Has("tendon_EA")) robot.tendon_EA = Positive(file, "tendon_EA");
  robot.gravity = Gravity(file.At("gravity"));
  if (const auto node = file.Find("base_rotation")) robot.base_rotation = Vector(*node);
  return robot;
}

namespace {

Eigen::Vector3d Vector(const CsvTable& table, std::size_t row, const std::string& name,
                       const std::string& end) {
  Eigen::Vector3d v;
  for (int i = 0; i < 3; ++i) v[i] = table.Number(row, name + "xyz"[i] + end);
  return v;
}

bool Has(const CsvTable& table, const std::string& name, const std::string& end) {
  return HasVector(table, {name + "x" + end, name + "y" + end, name + "z" + end});
}

// fx_i .., mx_i .. at disk i, and mx .. at the tip.
void ReadDiskLoads(const CsvTable& table, std::size_t row, const Robot& robot, Loads& loads) {
  const auto add = [&](const std::string& name, const std::string& end, int disk,
                       Eigen::Matrix3Xd& all) {
    if (!Has(table, name, end)) return;
    if (all.cols() == 0) all.setZero(3, robot.disks);
    all.col(disk) += Vector(table, row, name, end);
  };
  for (int i = 0; i < robot.disks; ++i) {
    add("f", "_" + std::to_string(i + 1), i, loads.disk_force);
    add("m", "_" + std::to_string(i + 1), i, loads.disk_moment);
  }
  add("m", "", robot.disks - 1, loads.disk_moment);
}

}  // namespace

std::vector<Case> ReadCases(const CsvTable& table, const Robot& robot) {
  RequireKnownCaseColumns(table, robot.tendons, robot.disks);
  const std::string drive = statics::DriveOf(table, {"L", "T"});
  std::vector<std::string> needed{"case", "fx", "fy", "fz"};
  for (int k = 1; k <= robot.tendons; ++k) needed.push_back(drive + std::to_string(k));
  HasVector(table, needed);
  table.RequireRows();
  const bool gravity = HasVector(table, {"gx", "gy", "gz"});
  const bool mu = table.Has("mu");
  std::vector<Case> cases(table.rows());
  for (std::size_t row = 0; row < table.rows(); ++row) {
    Case& c = cases[row];
    c.name = table.Text(row, "case");
    c.loads = NoLoads(robot);
    c.reference = Reference(table, row, cases);
    if (c.reference >= 0) {
      std::fill(c.loads.direction.begin(), c.loads.direction.end(), kAsItSlides);
    }
    if (drive == "L") c.loads.length.resize(robot.tendons);
    for (int k = 0; k < robot.tendons; ++k) {
      const auto i = static_cast<std::size_t>(k);
      const double value = ReadDrive(table, row, drive + std::to_string(k + 1));
      (drive == "L" ? c.loads.length[k] : c.loads.tension[i]) = value;
      const std::string direction = "dir" + std::to_string(k + 1);
      if (table.Has(direction)) c.loads.direction[i] = Direction(table, row, direction);
    }
    c.loads.tip_force = {table.Number(row, "fx"), table.Number(row, "fy"), table.Number(row, "fz")};
    ReadDiskLoads(table, row, robot, c.loads);
    if (gravity) {
      c.loads.gravity = {table.Number(row, "gx"), table.Number(row, "gy"), table.Number(row, "gz")};
    }
    if (mu) {
      c.loads.own_mu = true;
      c.loads.mu = Friction(table.Number(row, "mu"), table.Where(row) + ", column 'mu'");
    }
  }
  return cases;
}

}  // namespace continuum::tdcr
