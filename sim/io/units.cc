#include "sim/io/units.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string_view>
#include <utility>

#include "error.h"
#include "sim/io/unit_names.h"

namespace continuum {
namespace {

constexpr int kMostPower = 9;
constexpr int kMostParentheses = 8;  // within each other

// Other spellings of signs.
std::string Plain(std::string text) {
  static constexpr std::pair<std::string_view, std::string_view> kSpellings[]{
      {"\u00B7", "*"},         {"\u22C5", "*"},         {"\u00D7", "*"},         {"**", "^"},
      {"\u207B\u00B9", "^-1"}, {"\u207B\u00B2", "^-2"}, {"\u207B\u00B3", "^-3"}, {"\u00B2", "^2"},
      {"\u00B3", "^3"},        {" per ", "/"},          {" PER ", "/"}};
  for (const auto& [from, to] : kSpellings) {
    for (std::size_t at = 0; (at = text.find(from, at)) != text.npos; at += to.size())
      text.replace(at, from.size(), to);
  }
  return text;
}

bool IsDigit(char c) { return c >= '0' && c <= '9'; }
bool IsLetter(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return std::isalpha(byte) || c == '_' || c == '%' || byte >= 0x80;
}

// product = power { [ "*" | "." | "-" | "/" | blank ] power }, from left to right
// power   = ( name | number | "(" product ")" ) [ "^" integer | integer ]
class UnitParser {
 public:
  explicit UnitParser(std::string_view text) : text_(text) {}

  // Nothing for a text that is no product.
  std::optional<std::vector<UnitFactorPower>> Run() {
    std::vector<UnitFactorPower> all;
    if (!Product(1, all)) return {};
    SkipBlanks();
    if (at_ < text_.size() || all.empty()) return {};
    return all;
  }

 private:
  char Next() const { return at_ < text_.size() ? text_[at_] : '\0'; }
  void SkipBlanks() {
    while (Next() == ' ') ++at_;
  }
  bool Take(char c) {
    if (Next() != c) return false;
    ++at_;
    return true;
  }

  bool Product(int sign, std::vector<UnitFactorPower>& all) {
    SkipBlanks();
    if (!Power(sign, all)) return false;
    while (true) {
      SkipBlanks();
      if (at_ >= text_.size() || Next() == ')') return true;
      const bool divide = Take('/');
      if (!divide && Take('.') && IsDigit(Next())) return false;  // "m^1.5"
      if (!divide && !Take('*')) Take('-');
      SkipBlanks();
      if (!Power(divide ? -sign : sign, all)) return false;
    }
  }

  bool Power(int sign, std::vector<UnitFactorPower>& all) {
    std::vector<UnitFactorPower> factors;
    if (Take('(')) {
      if (++depth_ > kMostParentheses || !Product(1, factors) || !Take(')')) return false;
      --depth_;
    } else if (IsDigit(Next())) {
      factors.push_back({Number(), 1});
    } else if (IsLetter(Next())) {
      factors.push_back({Name(), 1});
    } else {
      return false;
    }
    const auto exponent = Exponent();
    if (!exponent) return false;
    for (auto& [name, power] : factors) {
      power *= sign * *exponent;
      if (std::abs(power) > kMostPower) return false;
      all.push_back({std::move(name), power});
    }
    return true;
  }

  std::string Number() {
    double value = 0;
    const char* const begin = text_.data() + at_;
    const char* const end = std::from_chars(begin, text_.data() + text_.size(), value).ptr;
    at_ += static_cast<std::size_t>(end - begin);
    return {begin, end};
  }

  // With the digits that belong to it ("cmH2O"); those of an exponent ("m2") stay.
  std::string Name() {
    std::size_t end = at_;
    while (end < text_.size() && (IsLetter(text_[end]) || IsDigit(text_[end]))) ++end;
    std::string name(text_.substr(at_, end - at_));
    while (!UnitNamed(name) && IsDigit(name.back())) name.pop_back();
    at_ += name.size();
    return name;
  }

  // 1 where there is none; nothing for one that is no integer from -9 to 9 but 0.
  std::optional<int> Exponent() {
    const bool caret = Take('^');
    const std::size_t digit = at_ + (Next() == '-' || Next() == '+');
    if (digit >= text_.size() || !IsDigit(text_[digit]))
      return caret ? std::nullopt : std::optional(1);
    const int sign = Next() == '-' ? -1 : 1;
    const int size = text_[digit] - '0';
    at_ = digit + 1;
    if (size == 0 || IsDigit(Next())) return {};
    return sign * size;
  }

  std::string_view text_;
  std::size_t at_ = 0;
  int depth_ = 0;
};

Unit OfFactor(const std::string& name, const std::string& unit, const std::string& where) {
  if (IsDigit(name.empty() ? ' ' : name[0])) {
    Unit number;
    std::from_chars(name.data(), name.data() + name.size(), number.factor);
    return number;
  }
  if (const auto found = UnitNamed(name)) return *found;
  throw Error::Input(
      where,
      "a unit made of names like m mm rad deg s min rpm kg g N lbf Nm J W Pa bar psi V "
      "A % 1 step, as in N*m or deg/s",
      "'" + unit + "'");
}

}  // namespace

std::vector<UnitFactorPower> FactorsOf(const std::string& unit) {
  const std::string plain = Plain(unit);
  auto factors = UnitParser(plain).Run();
  return factors ? std::move(*factors) : std::vector<UnitFactorPower>{{unit, 1}};
}

Unit ParseUnit(const std::string& unit, const std::string& where) {
  Unit product;
  for (const auto& [name, power] : FactorsOf(unit)) {
    const Unit part = OfFactor(name, unit, where);
    product.factor *= std::pow(part.factor, power);
    for (std::size_t d = 0; d < product.dimension.size(); ++d)
      product.dimension[d] += power * part.dimension[d];
    product.any &= part.any;
  }
  if (product.factor > 1e-100 && product.factor < 1e100) return product;
  throw Error::Input(where, "a unit of a size between 1e-100 and 1e100", "'" + unit + "'");
}

double UnitFactor(const std::string& unit, const std::string& where) {
  return ParseUnit(unit, where).factor;
}

void RequireUnitLike(const std::string& expected, const std::string& unit,
                     const std::string& where) {
  const Unit found = ParseUnit(unit, where);
  if (found.any || found.dimension == ParseUnit(expected, "").dimension) return;
  const bool gram = unit == "g" && expected == "m/s^2";
  throw Error::Input(where, "a unit like '" + expected + "'",
                     "'" + unit + "'" + (gram ? ", the gram; standard gravity is g0" : ""));
}

}  // namespace continuum
