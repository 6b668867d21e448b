#pragma once

#include <string>

namespace continuum {

/// The shortest decimal text that reads back as exactly this number.
std::string Decimal(double value);

}  // namespace continuum
