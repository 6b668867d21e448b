#include "sim/io/yaml.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <sstream>

#include <yaml-cpp/eventhandler.h>

#include "error.h"
#include "sim/io/decimal.h"
#include "sim/io/excerpt.h"
#include "sim/io/file.h"
#include "sim/io/units.h"

namespace continuum {
namespace {

// Reads the text as events: aliases are not followed, so a file that repeats itself or contains
// itself costs no more than its length.
class Keys : public YAML::EventHandler {
 public:
  explicit Keys(const std::string& name) : name_(name) {}

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark&, YAML::anchor_t) override { Item(); }
  void OnAlias(const YAML::Mark&, YAML::anchor_t) override { Item(); }
  void OnScalar(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                const std::string& value) override {
    if (IsKey()) Add(mark.line + 1, value);
    Item();
  }
  void OnSequenceStart(const YAML::Mark&, const std::string&, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {
    Item();
    open_.push_back({.is_map = false});
  }
  void OnSequenceEnd() override { open_.pop_back(); }
  void OnMapStart(const YAML::Mark&, const std::string&, YAML::anchor_t,
                  YAML::EmitterStyle::value) override {
    Item();
    open_.push_back({.is_map = true});
  }
  void OnMapEnd() override { open_.pop_back(); }

 private:
  struct Collection {
    bool is_map = false;
    std::size_t items = 0;                 // keys and values so far
    std::map<std::string, int> keys = {};  // with their lines
  };

  bool IsKey() const {
    return !open_.empty() && open_.back().is_map && open_.back().items % 2 == 0;
  }

  void Item() {
    if (!open_.empty()) ++open_.back().items;
  }

  void Add(int line, const std::string& key) {
    const auto [first, added] = open_.back().keys.emplace(key, line);
    if (added) return;
    throw Error::Input(
        name_ + ":" + std::to_string(line), "different keys",
        "'" + Excerpt(key) + "' twice, first in line " + std::to_string(first->second));
  }

  const std::string& name_;
  std::vector<Collection> open_;
};

// Throws Error (file:line) when a map has a key twice: the tree would take one of the two values
// and say nothing. Throws YAML::Exception for what is no YAML.
void RefuseRepeatedKeys(const std::string& text, const std::string& name) {
  std::istringstream stream(text);
  YAML::Parser parser(stream);
  Keys keys(name);
  parser.HandleNextDocument(keys);
}

}  // namespace

Yaml Yaml::Read(const std::filesystem::path& file) { return Parse(ReadFile(file), file.string()); }

Yaml Yaml::Parse(const std::string& text, std::string name) {
  try {
    Yaml root(YAML::Load(text), name, "");
    RefuseRepeatedKeys(text, name);
    if (!root.node_.IsMap()) throw Error::Input(name, "a map of keys", root.Found());
    return root;
  } catch (const YAML::Exception& e) {
    const bool anchor = e.msg.starts_with("the referenced anchor is not defined");
    throw Error::Input(name + ":" + std::to_string(e.mark.line + 1),
                       e.msg + (anchor ? " (text that begins with * needs quotes)" : ""));
  }
}

std::string Yaml::Where() const {
  const auto mark = node_.Mark();
  std::string where = file_;
  if (mark.line >= 0) where += ":" + std::to_string(mark.line + 1);
  return path_.empty() ? where : where + ": " + path_;
}

std::string Yaml::Found() const {
  if (!node_.IsDefined() || node_.IsNull()) return "nothing";
  if (node_.IsMap()) return "a map";
  if (node_.IsSequence()) return "a list";
  return "'" + Excerpt(node_.Scalar()) + "'";
}

bool Yaml::Has(const std::string& key) const { return node_.IsMap() && node_[key].IsDefined(); }

Yaml Yaml::At(const std::string& key) const {
  if (!node_.IsMap()) throw Error::Input(Where(), "a map with '" + key + "'", Found());
  if (!Has(key)) throw Error::Input(Where(), "the key '" + key + "'", "none");
  return {node_[key], file_, path_.empty() ? key : path_ + "." + key};
}

std::optional<Yaml> Yaml::Find(const std::string& key) const {
  if (!Has(key)) return std::nullopt;
  return At(key);
}

std::vector<Yaml> Yaml::Items() const {
  if (!node_.IsSequence()) throw Error::Input(Where(), "a list", Found());
  std::vector<Yaml> items;
  for (std::size_t i = 0; i < node_.size(); ++i) {
    items.push_back({node_[i], file_, path_ + "[" + std::to_string(i) + "]"});
  }
  return items;
}

std::vector<std::string> Yaml::Keys() const {
  if (!node_.IsMap()) throw Error::Input(Where(), "a map", Found());
  std::vector<std::string> keys;
  for (const auto& entry : node_) {
    if (!entry.first.IsScalar())
      throw Error::Input(Where(), "names as keys", entry.first.IsMap() ? "a map" : "a list");
    keys.push_back(entry.first.Scalar());
  }
  return keys;
}

void Yaml::Only(std::initializer_list<std::string_view> allowed) const {
  for (const auto& key : Keys()) {
    if (std::find(allowed.begin(), allowed.end(), key) != allowed.end()) continue;
    std::string all;
    for (const auto name : allowed) all += (all.empty() ? "" : ", ") + std::string(name);
    throw Error::Input(At(key).Where(), "one of the keys " + all, "'" + key + "'");
  }
}

std::string Yaml::Text() const {
  if (!node_.IsScalar()) throw Error::Input(Where(), "a text", Found());
  return node_.Scalar();
}

std::string Yaml::TextOr(const std::string& key, const std::string& fallback) const {
  const auto found = Find(key);
  return found ? found->Text() : fallback;
}

void Yaml::RefuseOption(const std::string& options) const {
  throw Error::Input(Where(), options, "'" + Text() + "'");
}

std::filesystem::path Yaml::File(const std::string& expected) const {
  const std::filesystem::path file = std::filesystem::path(file_).parent_path() / Text();
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored))
    throw Error::Input(Where(), expected, "no file " + file.string());
  if (std::filesystem::is_directory(file, ignored))
    throw Error::Input(Where(), expected, "a folder");
  return file;
}

double Yaml::Number() const {
  if (node_.IsScalar()) {
    const std::string& text = node_.Scalar();
    const bool plus = text.starts_with('+') && !text.starts_with("+-");
    const char* const begin = text.data() + (plus ? 1 : 0);
    double value = 0;
    const auto [end, error] = std::from_chars(begin, text.data() + text.size(), value);
    if (error == std::errc{} && end == text.data() + text.size() && std::isfinite(value)) {
      return value;
    }
  }
  throw Error::Input(Where(), "a finite number", Found());
}

double Yaml::NumberOr(const std::string& key, double fallback) const {
  const auto found = Find(key);
  return found ? found->Number() : fallback;
}

double Yaml::NumberOr(const std::string& key, double fallback, double lower, double upper) const {
  const auto found = Find(key);
  return found ? found->Number(lower, upper) : fallback;
}

double Yaml::Number(double lower, double upper) const {
  const double value = Number();
  if (lower <= value && value <= upper) return value;
  throw Error::Input(Where(), "a number in [" + Decimal(lower) + ", " + Decimal(upper) + "]",
                     Decimal(value));
}

int Yaml::Integer() const {
  const double value = Number();
  if (value == std::floor(value) && std::abs(value) <= std::numeric_limits<int>::max()) {
    return static_cast<int>(value);
  }
  throw Error::Input(Where(), "a whole number", Found());
}

bool Yaml::Bool() const {
  bool value = false;
  if (node_.IsScalar() && YAML::convert<bool>::decode(node_, value)) return value;
  throw Error::Input(Where(), "true or false", Found());
}

std::vector<double> Yaml::Numbers() const {
  std::vector<double> values;
  for (const Yaml& item : Items()) values.push_back(item.Number());
  return values;
}

Yaml Yaml::Quantity() const {
  if (!node_.IsMap()) return *this;
  Only({"value", "unit", "uncertainty", "source"});
  if (const auto unit = Find("unit")) {
    const std::string text = unit->Text();
    double factor = 1;
    try {
      factor = UnitFactor(text, "");
    } catch (const Error&) {  // no unit that we know: a remark
    }
    if (factor != 1) throw Error::Input(unit->Where(), "a unit of the SI", "'" + text + "'");
  }
  return At("value");
}

double Yaml::Parameter() const { return Quantity().Number(); }

double Yaml::Parameter(double lower, double upper) const { return Quantity().Number(lower, upper); }

std::vector<double> Yaml::Parameters() const { return Quantity().Numbers(); }

}  // namespace continuum
