#include "identification/diagnosis/law_terms.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

namespace continuum {
namespace {

// Powers of position, speed, motor or weight, and time in what a size is multiplied by.
struct Dimensions {
  int position = 0, speed = 0, force = 0, time = 0;
};

// "N*m*s^2/rad^2": of a size whose product with such a quantity is a force.
std::string UnitOver(const Dimensions& of, bool slides) {
  std::string above, below;
  const auto put = [&](const std::string& unit, int power) {
    std::string& side = power > 0 ? above : below;
    if (power == 0) return;
    side += (side.empty() ? "" : "*") + unit;
    if (std::abs(power) > 1) side += fmt::format("^{}", std::abs(power));
  };
  put("N", 1 - of.force);
  if (!slides) put("m", 1 - of.force);
  put("s", of.speed - of.time);
  put(slides ? "m" : "rad", -of.position - of.speed);
  if (above.empty()) above = "1";
  if (below.empty()) return above;
  return above + "/" + (below.find('*') == below.npos ? below : "(" + below + ")");
}

std::vector<double> Spaced(double first, double last, int count) {
  std::vector<double> values;
  for (int i = 0; i < count; ++i) values.push_back(first + (last - first) * i / (count - 1));
  return values;
}
std::vector<double> Ratios(double first, double last, double factor) {
  std::vector<double> values;
  for (double x = first; x < last * 1.0001; x *= factor) values.push_back(x);
  return values;
}

class Terms {
 public:
  explicit Terms(const JointReach& reach) : reach_(reach), span_(reach.upper - reach.lower) {}

  std::vector<LawTerm> OfOneJoint() {
    if (span_ > 0) OfPosition();
    OfSpeed();
    OfMotor();
    OfTime();
    OfHeat();
    return std::move(all_);
  }

  std::vector<LawTerm> OfTwo(const JointReach& other) {
    all_ = WithAnother(other, "other");
    if (reach_.slides != other.slides) return std::move(all_);
    Add("(q - q[other])", {1});
    Add("(q - q[other])^3", {3});
    Add("(v - v[other])", {0, 1});
    Add("(v - v[other])*abs(v - v[other])", {0, 2});
    Add("(q + q[other])^3", {3});
    span_ += other.upper - other.lower;
    if (span_ > 0) AddWave("(q + q[other])", Frequency());
    return std::move(all_);
  }

  std::vector<LawTerm> WithAnother(const JointReach& other, const std::string& name) {
    const std::string q = "q[" + name + "]", v = "v[" + name + "]";
    // What moves along with it would be of both joints' units: those of the other one count.
    const auto unit = [&](Dimensions own, Dimensions others) {
      own.position += others.position, own.speed += others.speed;
      return UnitOver(own, reach_.slides && other.slides);
    };
    const auto add = [&](const std::string& text, Dimensions own, Dimensions others) {
      all_.push_back({{{text, unit(own, others)}}});
    };
    add(q, {}, {1});
    add(v, {}, {0, 1});
    add(q + "^2", {}, {2});
    add(q + "*abs(" + q + ")", {}, {2});
    add(q + "^3", {}, {3});
    add(v + "^2", {}, {0, 2});
    add(v + "*abs(" + v + ")", {}, {0, 2});
    add("q*" + q, {1}, {1});
    add("q*" + q + "^2", {1}, {2});
    add("v*" + v, {0, 1}, {0, 1});
    add("v*abs(" + q + ")", {0, 1}, {1});
    add("v*abs(" + v + ")", {0, 1}, {0, 1});
    add("motor*" + q, {0, 0, 1}, {1});
    add("motor*abs(" + q + ")", {0, 0, 1}, {1});
    const double span = other.upper - other.lower;
    if (span > 0) AddWave(q, Terms(other).Frequency());
    return std::move(all_);
  }

 private:
  void Add(const std::string& text, const Dimensions& of, std::vector<TermShape> shapes = {}) {
    all_.push_back({{{text, UnitOver(of, reach_.slides)}}, std::move(shapes)});
  }
  void AddPlain(const std::string& text, const Dimensions& of) {
    Add(text, of);
    all_.back().plain = true;
  }
  // Of any phase.
  void AddWave(const std::string& of, TermShape frequency) {
    const std::string unit = UnitOver({}, reach_.slides);
    all_.push_back(
        {{{"sin(s1*" + of + ")", unit}, {"cos(s1*" + of + ")", unit}}, {std::move(frequency)}});
  }

  std::string Position() const { return reach_.slides ? "m" : "rad"; }
  TermShape Place(const std::string& name, int count) const {
    const double edge = span_ / (2 * count);
    return {name, Position(), reach_.lower - span_, reach_.upper + span_,
            Spaced(reach_.lower + edge, reach_.upper - edge, count)};
  }
  TermShape Width(const std::string& name) const {
    return {name, Position(), span_ / 50, 3 * span_, Ratios(span_ / 16, span_ / 2, 2)};
  }
  // From two thirds of a wave over the range to one that four rows still show.
  TermShape Frequency() const {
    const double turn = 2 * std::numbers::pi;
    const double least = 0.67 * turn / span_;
    const double most =
        std::min(150 * turn / span_, turn / (4 * std::max(reach_.speed * reach_.period, 1e-12)));
    std::vector<double> grid;
    for (double f = least; f <= std::max(least, most); f += turn / (6 * span_)) grid.push_back(f);
    return {"s1", "1/" + Position(), least / 2, 2 * std::max(least, most), grid};
  }

  void OfPosition() {
    AddPlain("q", {1});
    Add("q*abs(q)", {2});
    Add("q^2", {2});
    Add("q^3", {3});
    AddWave("q", Frequency());
    Add("max(0, q - s1)", {1}, {Place("s1", 12)});
    Add("min(0, q - s1)", {1}, {Place("s1", 12)});
    Add("max(0, q - s1)^2", {2}, {Place("s1", 12)});
    Add("min(0, q - s1)^2", {2}, {Place("s1", 12)});
    for (const char* const sign : {"", "-"}) {
      Add(std::string("exp(") + sign + "q/s1)", {},
          {{"s1", Position(), span_ / 20, 5 * span_, Ratios(span_ / 8, 2 * span_, 1.6)}});
    }
    Add("exp(-((q - s1)/s2)^2)", {}, {Place("s1", 12), Width("s2")});
    Add("(q - s1)*exp(-((q - s1)/s2)^2)", {1}, {Place("s1", 12), Width("s2")});
    Add("v*abs(q)", {1, 1});
    Add("v*q", {1, 1});
    Add("v*q^2", {2, 1});
    Add("v*exp(-((q - s1)/s2)^2)", {0, 1}, {Place("s1", 12), Width("s2")});
  }
  void OfSpeed() {
    AddPlain("v", {0, 1});
    AddPlain("v", {0, 1});
    Add("abs(v)", {0, 1});
    Add("v*abs(v)", {0, 2});
    Add("v^2", {0, 2});
    Add("v^3", {0, 3});
    if (!(reach_.speed > 0)) return;
    const std::string unit = Position() + "/s";
    const double v = reach_.speed;
    Add("tanh(v/s1)", {}, {{"s1", unit, v / 100, 10 * v, Ratios(v / 20, 2 * v, 2)}});
    Add("v/(1 + (v/s1)^2)", {0, 1}, {{"s1", unit, v / 30, 10 * v, Ratios(v / 8, 2 * v, 2)}});
  }
  void OfMotor() {
    AddPlain("motor", {0, 0, 1});
    Add("motor*abs(motor)", {0, 0, 2});
    Add("abs(motor)", {0, 0, 1});
    Add("motor^3", {0, 0, 3});
    Add("motor*q", {1, 0, 1});
    Add("motor*abs(q)", {1, 0, 1});
    Add("motor*q^2", {2, 0, 1});
    Add("motor*v", {0, 1, 1});
    Add("motor*abs(v)", {0, 1, 1});
    Add("motor*weight", {0, 0, 2});
    Add("motor*abs(weight)", {0, 0, 2});
    AddPlain("weight", {0, 0, 1});
    Add("weight*abs(weight)", {0, 0, 2});
    Add("v*abs(weight)", {0, 1, 1});
    Add("v*abs(motor)", {0, 1, 1});
  }
  void OfTime() {
    const double most = reach_.duration;
    if (!(most > 0)) return;
    const TermShape constant{"s1", "s", most / 100, 10 * most, Ratios(most / 30, most, 2)};
    Add("time", {0, 0, 0, 1});
    Add("exp(-time/s1)", {}, {constant});
    Add("motor*time", {0, 0, 1, 1});
    Add("motor*exp(-time/s1)", {0, 0, 1}, {constant});
    Add("v*time", {0, 1, 0, 1});
    Add("v*exp(-time/s1)", {0, 1}, {constant});
    Add("q*time", {1, 0, 0, 1});
    const double turn = 2 * std::numbers::pi, least = turn / most;
    const double last = std::min(40 * least, turn / (10 * reach_.period));
    std::vector<double> grid;
    for (double f = least; f <= last; f += least / 4) grid.push_back(f);
    AddWave("time", {"s1", "1/s", least / 2, 2 * last, grid});
  }
  void OfHeat() {
    const double most = reach_.duration;
    const TermShape time{"heat_time", "s", most / 300, 100 * most,
                         Ratios(most / 40, 10 * most, 1.8)};
    Add("heat", {0, 0, 2}, {time});
    Add("motor*heat", {0, 0, 3}, {time});
    Add("v*heat", {0, 1, 2}, {time});
    Add("q*heat", {1, 0, 2}, {time});
  }

  const JointReach& reach_;
  double span_;
  std::vector<LawTerm> all_;
};

}  // namespace

std::vector<std::vector<double>> LawTerm::Grid() const {
  std::vector<std::vector<double>> all{{}};
  for (const TermShape& shape : shapes) {
    std::vector<std::vector<double>> longer;
    for (const std::vector<double>& some : all) {
      for (const double value : shape.grid) {
        longer.push_back(some);
        longer.back().push_back(value);
      }
    }
    all = std::move(longer);
  }
  return all;
}

JointReach ReachOf(const MissingForce& joint) {
  JointReach reach;
  reach.slides = joint.slides;
  if (joint.angle.empty()) return reach;
  const auto [least, most] = std::minmax_element(joint.angle.begin(), joint.angle.end());
  reach.lower = *least, reach.upper = *most;
  double squares = 0, begin = joint.time.front();
  for (std::size_t k = 0; k < joint.angle.size(); ++k) {
    squares += joint.velocity[k] * joint.velocity[k];
    if (k > 0 && joint.log[k] != joint.log[k - 1]) begin = joint.time[k];
    reach.duration = std::max(reach.duration, joint.time[k] - begin);
  }
  reach.speed = std::sqrt(squares / static_cast<double>(joint.angle.size()));
  reach.period = joint.time.size() > 1 ? joint.time[1] - joint.time[0] : 0;
  return reach;
}

std::vector<LawTerm> TermsOf(const JointReach& reach) { return Terms(reach).OfOneJoint(); }

std::vector<LawTerm> TermsWith(const JointReach& reach, const JointReach& other,
                               const std::string& name) {
  return Terms(reach).WithAnother(other, name);
}

std::vector<LawTerm> TermsWith(const JointReach& reach, const std::string& one,
                               const std::string& other) {
  const auto term = [&](const std::string& variable, const Dimensions& of) {
    const std::string text = variable + "[" + one + "]*" + variable + "[" + other + "]";
    return LawTerm{{{text, UnitOver(of, reach.slides)}}};
  };
  return {term("q", {2}), term("v", {0, 2})};
}

std::vector<LawTerm> TermsOfTwo(const JointReach& one, const JointReach& other) {
  return Terms(one).OfTwo(other);
}

}  // namespace continuum
