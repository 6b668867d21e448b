#pragma once

#include <stdexcept>
#include <string>
#include <utility>

namespace continuum {

/// The one exception of the project. `kInput` is wrong use or bad input (exit code 2), `kJob` a job
/// that failed although its input was good (exit code 1).
class Error : public std::runtime_error {
 public:
  enum class Kind { kInput, kJob };

  /// Bad input. where: "file:line", a key or an attribute.
  static Error Input(const std::string& where, const std::string& expected,
                     const std::string& found) {
    return {Kind::kInput, where + ": expected " + expected + ", found " + found};
  }
  static Error Input(const std::string& where, const std::string& what) {
    return {Kind::kInput, where.empty() ? what : where + ": " + what};
  }
  /// A job that diverged or did not converge.
  static Error Job(const std::string& what) { return {Kind::kJob, what}; }

  Kind kind() const { return kind_; }
  int exit_code() const { return kind_ == Kind::kInput ? 2 : 1; }

 private:
  Error(Kind kind, const std::string& what) : std::runtime_error(what), kind_(kind) {}
  Kind kind_;
};

}  // namespace continuum
