#include "sim/experiment/formula_candidate.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "binding/expression.h"
#include "effects/all.h"
#include "error.h"
#include "sim/experiment/bounds_reader.h"
#include "sim/io/yaml.h"

namespace continuum {
namespace {

using Names = std::vector<std::string>;

bool Holds(const Names& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

// Where a parameter makes the law do nothing, NaN when it never does.
double ReadNull(const Yaml& y, const Parameter& p) {
  const auto null = y.Find("absent");
  return null ? null->Number(p.lower, p.upper) : std::numeric_limits<double>::quiet_NaN();
}

Parameter ReadOne(const Yaml& y, const Names& taken) {
  y.Only({"name", "unit", "initial", "lower", "upper", "absent"});
  Parameter p;
  p.where = y.Where();
  p.name = y.At("name").Text();
  if (!Expression::IsName(p.name) || Holds(taken, p.name)) {
    throw Error::Input(y.At("name").Where(), "a name of letters and digits that means nothing else",
                       "'" + p.name + "'");
  }
  const auto unit = y.Find("unit");
  p.unit = unit ? unit->Text() : "1";
  ReadBounds(y, p);
  p.initial = y.At("initial").Number(p.lower, p.upper);
  p.has_initial = true;
  return p;
}

std::string ReadName(const Yaml& y) {
  const std::string name = y.Text();
  bool known = IsWritten(name) || !Expression::IsName(name);
  All::ForEach([&]<class E>() { known |= name == E::kName; });
  if (!known) return name;
  throw Error::Input(y.Where(), "a name of letters and digits that no effect has",
                     "'" + name + "'");
}

template <FormulaLaw E>
Candidate Read(const Yaml& y) {
  const std::string key(E::kText);
  y.Only({"effect", "where", "name", key, "parameters"});
  Candidate c{std::string(E::kName), y.Has("where") ? y.At("where").Text() : "", false, {}};
  WrittenLaw law{ReadName(y.At("name")), y.At(key).Text(), {}, {}};
  Names names(E::kVariables.begin(), E::kVariables.end());
  for (const Yaml& item : y.At("parameters").Items()) {
    law.parameters.push_back(ReadOne(item, names));
    law.null.push_back(ReadNull(item, law.parameters.back()));
    names.push_back(law.parameters.back().name);
  }
  if (law.parameters.size() > E::kParams.size()) {
    throw Error::Input(y.At("parameters").Where(),
                       "at most " + std::to_string(E::kParams.size()) + " parameters",
                       std::to_string(law.parameters.size()));
  }
  if (std::all_of(law.null.begin(), law.null.end(), [](double x) { return std::isnan(x); })) {
    throw Error::Input(y.At("parameters").Where(),
                       "a parameter with absent, the value at which the law does nothing", "none");
  }
  for (const std::string& other : Expression::BracketNames(law.formula)) names.push_back(other);
  const Expression parsed(law.formula, names, y.At(key).Where());
  c.law = std::move(law);
  return c;
}

}  // namespace

bool IsWritten(const std::string& effect) {
  bool written = false;
  FormulaLaws::ForEach([&]<class E>() { written |= effect == E::kName; });
  return written;
}

Candidate ReadWrittenLaw(const Yaml& y, const std::string& effect) {
  Candidate c;
  FormulaLaws::ForEach([&]<class E>() {
    if (effect == E::kName) c = Read<E>(y);
  });
  return c;
}

}  // namespace continuum
