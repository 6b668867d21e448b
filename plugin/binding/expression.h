#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace continuum {

/// A formula of named variables, evaluated without allocation.
///
///   formula = { name "=" sum ";" } sum                     names for parts that are used again
///   sum     = product { ("+" | "-") product }
///   product = sign { ("*" | "/") sign }
///   sign    = { "+" | "-" } power
///   power   = atom [ "^" sign ]
///   atom    = number | name | function "(" sum { "," sum } ")" | "(" sum ")"
///   name    = letters and digits [ "[" anything "]" ]       "q[elbow]", spaces and all
///
/// Functions: abs sign sqrt exp log sin cos tan tanh atan, of two min max atan2 pow, and
/// where(c, a, b): a where c > 0, else b. pi is 3.14159... What is constant must be finite: no 1/0.
class Expression {
 public:
  /// Throws Error (where, and the column) for anything else than a formula of these variables.
  Expression(std::string_view text, const std::vector<std::string>& variables,
             const std::string& where);

  /// values: of the variables, in their order.
  double operator()(std::span<const double> values) const;
  /// The same with its derivatives with respect to the variables, 0 where it does not follow them.
  double Differentiate(std::span<const double> values, std::span<double> slopes) const;

  /// Whether its value depends on a variable.
  bool Uses(std::size_t variable) const;

  /// The names with brackets of a text, each once: "q[elbow]".
  static std::vector<std::string> BracketNames(std::string_view text);
  /// Whether a variable can have this name: a letter or "_", then letters, digits and "_"; not pi
  /// and not a function.
  static bool IsName(std::string_view name);
  /// The text with other names for variables, all at once.
  static std::string Renamed(std::string_view text, const std::vector<std::string>& from,
                             const std::vector<std::string>& to);

  /// One step of a stack machine: puts a number, a variable or a part on the stack, or replaces
  /// what is on top of it by a function.
  struct Step {
    enum class Kind { kNumber, kVariable, kPart, kFunction } kind;
    double number = 0;
    std::size_t index = 0;
    void (*function)(double*& top) = nullptr;
    std::size_t arguments = 0;
    /// Writes the derivatives of a function with respect to its arguments.
    void (*slopes)(const double* arguments, double* slopes) = nullptr;
  };

 private:
  std::vector<Step> steps_;
};

}  // namespace continuum
