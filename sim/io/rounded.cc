#include "sim/io/rounded.h"

#include <fmt/format.h>

namespace continuum {
namespace {

std::string WithoutSignOfZero(std::string text) {
  const bool zero = text.starts_with('-') && text.find_first_not_of("-0.") == text.npos;
  return zero ? text.substr(1) : text;
}

}  // namespace

std::string Fixed(double value, int digits) {
  return WithoutSignOfZero(fmt::format("{:.{}f}", value, digits));
}

std::string Significant(double value, int digits) {
  return WithoutSignOfZero(fmt::format("{:.{}g}", value, digits));
}

std::string Percent(double share, int digits) { return Fixed(100 * share, digits) + " %"; }

}  // namespace continuum
