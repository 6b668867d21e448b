#include "identification/candidates/unit_powers.h"

#include "sim/io/units.h"

namespace continuum {

Powers PowersOf(std::string_view unit) {
  Powers all;
  for (const auto& [name, power] : FactorsOf(std::string(unit))) {
    if (name == "J") {
      all["N"] += power, all["m"] += power;
    } else if (name != "1") {
      all[name] += power;
    }
  }
  std::erase_if(all, [](const auto& one) { return one.second == 0; });
  return all;
}

}  // namespace continuum
