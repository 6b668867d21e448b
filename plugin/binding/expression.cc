#include "binding/expression.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "error.h"

namespace continuum {
namespace {

using Step = Expression::Step;
using Names = std::vector<std::string>;

constexpr std::size_t kStack = 256;  ///< numbers on the stack at once
constexpr int kDepth = 200;          ///< parentheses within parentheses
constexpr double kVaries = std::numeric_limits<double>::quiet_NaN();  ///< no constant

bool IsLetter(char c) { return ('a' <= c && c <= 'z') || ('A' <= c && c <= 'Z') || c == '_'; }
bool IsDigit(char c) { return '0' <= c && c <= '9'; }
bool IsSpace(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

// The length of the name that a text begins with.
std::size_t NameLength(std::string_view text) {
  if (text.empty() || !IsLetter(text.front())) return 0;
  const auto end =
      std::find_if(text.begin(), text.end(), [](char c) { return !IsLetter(c) && !IsDigit(c); });
  return static_cast<std::size_t>(end - text.begin());
}

// The same with the brackets behind it, if any.
std::size_t BracketLength(std::string_view text) {
  const std::size_t n = NameLength(text);
  if (n == 0 || n == text.size() || text[n] != '[') return n;
  const std::size_t end = text.find(']', n);
  return end == text.npos ? n : end + 1;
}

std::optional<std::size_t> IndexOf(const Names& names, std::string_view name) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) return {};
  return static_cast<std::size_t>(found - names.begin());
}

template <double (*F)(double)>
void One(double*& top) {
  top[-1] = F(top[-1]);
}
template <double (*F)(double, double)>
void Two(double*& top) {
  --top;
  top[-1] = F(top[-1], top[0]);
}
void Where(double*& top) {
  top -= 2;
  top[-1] = top[-1] > 0 ? top[0] : top[1];
}

void WhereSlopes(const double* x, double* slopes) {
  slopes[0] = 0, slopes[1] = x[0] > 0, slopes[2] = !(x[0] > 0);
}

template <double (*F)(double)>
void OneSlope(const double* x, double* slopes) {
  slopes[0] = F(x[0]);
}
template <double (*Fx)(double, double), double (*Fy)(double, double)>
void TwoSlopes(const double* x, double* slopes) {
  slopes[0] = Fx(x[0], x[1]), slopes[1] = Fy(x[0], x[1]);
}

// ∂ x^y / ∂x and ∂y.
double PowerByBase(double x, double y) { return y == 0 ? 0 : y * std::pow(x, y - 1); }
double PowerByExponent(double x, double y) { return x > 0 ? std::pow(x, y) * std::log(x) : 0; }
double Square(double x) { return x * x; }

struct Function {
  std::string_view name;
  std::size_t arguments;
  void (*run)(double*& top);
  void (*slopes)(const double* arguments, double* slopes);
};
constexpr std::array kFunctions{
    Function{"abs", 1, One<[](double x) { return std::abs(x); }>,
             OneSlope<[](double x) { return x < 0 ? -1.0 : 1.0; }>},
    Function{"sign", 1, One<[](double x) { return static_cast<double>((x > 0) - (x < 0)); }>,
             OneSlope<[](double) { return 0.0; }>},
    Function{"sqrt", 1, One<[](double x) { return std::sqrt(x); }>,
             OneSlope<[](double x) { return 0.5 / std::sqrt(x); }>},
    Function{"exp", 1, One<[](double x) { return std::exp(x); }>,
             OneSlope<[](double x) { return std::exp(x); }>},
    Function{"log", 1, One<[](double x) { return std::log(x); }>,
             OneSlope<[](double x) { return 1 / x; }>},
    Function{"sin", 1, One<[](double x) { return std::sin(x); }>,
             OneSlope<[](double x) { return std::cos(x); }>},
    Function{"cos", 1, One<[](double x) { return std::cos(x); }>,
             OneSlope<[](double x) { return -std::sin(x); }>},
    Function{"tan", 1, One<[](double x) { return std::tan(x); }>,
             OneSlope<[](double x) { return 1 + Square(std::tan(x)); }>},
    Function{"tanh", 1, One<[](double x) { return std::tanh(x); }>,
             OneSlope<[](double x) { return 1 - Square(std::tanh(x)); }>},
    Function{"atan", 1, One<[](double x) { return std::atan(x); }>,
             OneSlope<[](double x) { return 1 / (1 + x * x); }>},
    Function{"min", 2, Two<[](double x, double y) { return std::min(x, y); }>,
             TwoSlopes<[](double x, double y) { return y < x ? 0.0 : 1.0; },
                       [](double x, double y) { return y < x ? 1.0 : 0.0; }>},
    Function{"max", 2, Two<[](double x, double y) { return std::max(x, y); }>,
             TwoSlopes<[](double x, double y) { return x < y ? 0.0 : 1.0; },
                       [](double x, double y) { return x < y ? 1.0 : 0.0; }>},
    Function{"atan2", 2, Two<[](double x, double y) { return std::atan2(x, y); }>,
             TwoSlopes<[](double x, double y) { return y / (x * x + y * y); },
                       [](double x, double y) { return -x / (x * x + y * y); }>},
    Function{"pow", 2, Two<[](double x, double y) { return std::pow(x, y); }>,
             TwoSlopes<PowerByBase, PowerByExponent>},
    Function{"where", 3, Where, WhereSlopes},
};
constexpr Function kNegate{"-", 1, One<[](double x) { return -x; }>,
                           OneSlope<[](double) { return -1.0; }>};
constexpr Function kAdd{
    "+", 2, Two<[](double x, double y) { return x + y; }>,
    TwoSlopes<[](double, double) { return 1.0; }, [](double, double) { return 1.0; }>};
constexpr Function kSubtract{
    "-", 2, Two<[](double x, double y) { return x - y; }>,
    TwoSlopes<[](double, double) { return 1.0; }, [](double, double) { return -1.0; }>};
constexpr Function kMultiply{
    "*", 2, Two<[](double x, double y) { return x * y; }>,
    TwoSlopes<[](double, double y) { return y; }, [](double x, double) { return x; }>};
constexpr Function kDivide{"/", 2, Two<[](double x, double y) { return x / y; }>,
                           TwoSlopes<[](double, double y) { return 1 / y; },
                                     [](double x, double y) { return -x / (y * y); }>};
constexpr Function kPower{"^", 2, Two<[](double x, double y) { return std::pow(x, y); }>,
                          TwoSlopes<PowerByBase, PowerByExponent>};

const Function* FunctionNamed(std::string_view name) {
  const auto found = std::find_if(kFunctions.begin(), kFunctions.end(),
                                  [&](const Function& f) { return f.name == name; });
  return found == kFunctions.end() ? nullptr : &*found;
}

// Recursive descent: one method for each line of the grammar.
class Parser {
 public:
  Parser(std::string_view text, const Names& variables, const std::string& where)
      : text_(text), variables_(variables), where_(where) {}

  std::vector<Step> Formula() {
    while (const auto part = Assigned()) {
      Sum();
      if (!Take(';')) Refuse("';' after the part '" + *part + "'");
      parts_.push_back(*part);  // it stays where it is on the stack, at the bottom
    }
    Sum();
    if (Space(), at_ < text_.size()) Refuse("an operator or the end");
    return std::move(steps_);
  }

 private:
  [[noreturn]] void Refuse(const std::string& expected) {
    Space();
    const std::string rest(text_.substr(at_, 20));
    throw Error::Input(where_ + ", column " + std::to_string(at_ + 1), expected,
                       rest.empty() ? "the end of the formula" : "'" + rest + "'");
  }
  void Space() {
    while (at_ < text_.size() && IsSpace(text_[at_])) ++at_;
  }
  bool Take(char c) {
    Space();
    const bool there = at_ < text_.size() && text_[at_] == c;
    at_ += there;
    return there;
  }
  std::string_view Name() {
    Space();
    const std::string_view name = text_.substr(at_, BracketLength(text_.substr(at_)));
    at_ += name.size();
    return name;
  }

  // The name of the part that comes next, and moves behind its "="; none: at_ stays.
  std::optional<std::string> Assigned() {
    const std::size_t before = at_;
    const std::string name(Name());
    const bool assigns = !name.empty() && Take('=');
    const bool fresh =
        Expression::IsName(name) && !IndexOf(variables_, name) && !IndexOf(parts_, name);
    if (!assigns || !fresh) at_ = before;
    if (!assigns) return {};
    if (!fresh) Refuse("a new name for a part");
    return name;
  }

  void Put(Step step) {
    if (values_.size() == kStack) Refuse("a shorter formula");
    steps_.push_back(step);
    const bool part = step.kind == Step::Kind::kPart;
    const bool number = step.kind == Step::Kind::kNumber;
    values_.push_back(part ? values_[step.index] : number ? step.number : kVaries);
  }
  void Call(const Function& f) {
    steps_.push_back({Step::Kind::kFunction, 0, 0, f.run, f.arguments, f.slopes});
    const auto arguments = values_.end() - static_cast<std::ptrdiff_t>(f.arguments);
    const bool constant =
        std::none_of(arguments, values_.end(), [](double x) { return std::isnan(x); });
    double* top = values_.data() + values_.size();
    f.run(top);
    const double value = constant ? top[-1] : kVaries;
    values_.resize(values_.size() - f.arguments + 1);
    values_.back() = value;
    if (constant && !std::isfinite(value)) RefuseConstant(f.name, value);
  }
  [[noreturn]] void RefuseConstant(std::string_view function, double value) const {
    throw Error::Input(where_ + ", up to column " + std::to_string(at_),
                       "a finite constant from '" + std::string(function) + "'",
                       std::isnan(value) ? "none"
                       : value > 0       ? "infinity"
                                         : "-infinity");
  }
  void Deeper() {
    if (++depth_ > kDepth) Refuse("fewer parentheses within each other");
  }

  void Sum() {
    Deeper();
    Product();
    while (true) {
      if (Take('+')) {
        Product();
        Call(kAdd);
      } else if (Take('-')) {
        Product();
        Call(kSubtract);
      } else {
        break;
      }
    }
    --depth_;
  }
  void Product() {
    Sign();
    while (true) {
      if (Take('*')) {
        Sign();
        Call(kMultiply);
      } else if (Take('/')) {
        Sign();
        Call(kDivide);
      } else {
        return;
      }
    }
  }
  void Sign() {
    bool negative = false;
    while (true) {
      if (Take('-')) {
        negative = !negative;
      } else if (!Take('+')) {
        break;
      }
    }
    Power();
    if (negative) Call(kNegate);
  }
  void Power() {
    Atom();
    if (!Take('^')) return;
    Deeper();
    Sign();
    Call(kPower);
    --depth_;
  }
  void Atom() {
    if (Take('(')) {
      Sum();
      return Close();
    }
    if (at_ < text_.size() && (IsDigit(text_[at_]) || text_[at_] == '.')) return Number();
    const std::size_t before = at_;
    const std::string_view name = Name();
    if (const Function* const f = FunctionNamed(name)) return Arguments(*f);
    if (const auto v = IndexOf(variables_, name)) return Put({Step::Kind::kVariable, 0, *v});
    if (const auto part = IndexOf(parts_, name)) return Put({Step::Kind::kPart, 0, *part});
    if (name == "pi") return Put({Step::Kind::kNumber, std::numbers::pi});
    at_ = before;
    std::string all;
    for (const auto& v : variables_) all += v + ", ";
    Refuse("a number, '(', a function or one of " + all + "pi");
  }
  void Number() {
    double number = 0;
    const char* const begin = text_.data() + at_;
    const auto [end, error] = std::from_chars(begin, text_.data() + text_.size(), number);
    if (error != std::errc{}) Refuse("a number");
    at_ += static_cast<std::size_t>(end - begin);
    Put({Step::Kind::kNumber, number});
  }
  void Arguments(const Function& f) {
    for (std::size_t i = 0; i < f.arguments; ++i) {
      const char before = i == 0 ? '(' : ',';
      if (!Take(before)) Refuse("'" + std::string(1, before) + "' of " + std::string(f.name));
      Sum();
    }
    Close();
    Call(f);
  }
  void Close() {
    if (!Take(')')) Refuse("')'");
  }

  std::string_view text_;
  const Names& variables_;
  const std::string& where_;
  std::vector<Step> steps_;
  Names parts_;
  std::vector<double> values_;  ///< of what is on the stack, as far as it is constant
  std::size_t at_ = 0;
  int depth_ = 0;
};

}  // namespace

Expression::Expression(std::string_view text, const Names& variables, const std::string& where)
    : steps_(Parser(text, variables, where).Formula()) {}

double Expression::operator()(std::span<const double> values) const {
  std::array<double, kStack> stack;
  double* top = stack.data();
  for (const Step& step : steps_) {
    switch (step.kind) {
      case Step::Kind::kNumber:
        *top++ = step.number;
        break;
      case Step::Kind::kVariable:
        *top++ = values[step.index];
        break;
      case Step::Kind::kPart:
        *top++ = stack[step.index];
        break;
      case Step::Kind::kFunction:
        step.function(top);
        break;
    }
  }
  return top[-1];
}

double Expression::Differentiate(std::span<const double> values, std::span<double> slopes) const {
  const std::size_t n = values.size();
  std::vector<double> stack(kStack), of(kStack * n);  // [place on the stack, variable]
  double* top = stack.data();
  const auto row = [&](const double* place) { return of.data() + (place - stack.data()) * n; };
  for (const Step& step : steps_) {
    if (step.kind != Step::Kind::kFunction) {
      const bool part = step.kind == Step::Kind::kPart;
      const bool variable = step.kind == Step::Kind::kVariable;
      *top = part ? stack[step.index] : variable ? values[step.index] : step.number;
      if (part) std::copy_n(of.data() + step.index * n, n, row(top));
      if (!part) std::fill_n(row(top), n, 0.0);
      if (variable) row(top)[step.index] = 1;
      ++top;
      continue;
    }
    double partial[3];
    double* const first = top - step.arguments;
    step.slopes(first, partial);
    for (std::size_t i = 0; i < n; ++i) {
      double sum = 0;  // what follows nothing counts nothing, however steep
      for (std::size_t k = 0; k < step.arguments; ++k)
        if (const double by = row(first + k)[i]; by != 0) sum += partial[k] * by;
      row(first)[i] = sum;
    }
    step.function(top);
  }
  std::copy_n(row(top - 1), n, slopes.begin());
  return top[-1];
}

bool Expression::Uses(std::size_t variable) const {
  return std::any_of(steps_.begin(), steps_.end(), [&](const Step& step) {
    return step.kind == Step::Kind::kVariable && step.index == variable;
  });
}

Names Expression::BracketNames(std::string_view text) {
  Names names;
  while (!text.empty()) {
    const std::size_t n = BracketLength(text);
    const std::string_view name = text.substr(0, n);
    if (n > NameLength(text) && !IndexOf(names, name)) names.emplace_back(name);
    text.remove_prefix(std::max<std::size_t>(n, 1));
  }
  return names;
}

bool Expression::IsName(std::string_view name) {
  return !name.empty() && NameLength(name) == name.size() && name != "pi" && !FunctionNamed(name);
}

std::string Expression::Renamed(std::string_view text, const Names& from, const Names& to) {
  std::string out;
  while (!text.empty()) {
    const std::size_t n = BracketLength(text);
    const auto index = n > 0 ? IndexOf(from, text.substr(0, n)) : std::nullopt;
    // A number with an exponent, 1e3, is no name.
    std::size_t length = std::max<std::size_t>(n, 1);
    if (IsDigit(text.front()) || text.front() == '.') {
      while (length < text.size() && (IsDigit(text[length]) || text[length] == '.')) ++length;
      if (length < text.size() && (text[length] == 'e' || text[length] == 'E')) ++length;
    }
    out += index ? to[*index] : std::string(text.substr(0, length));
    text.remove_prefix(length);
  }
  return out;
}

}  // namespace continuum
