// A log as CSV: every cell as text, number and flag.
#include <cmath>

#include "fuzz/fuzz.h"
#include "sim/io/csv.h"

namespace continuum {
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return fuzz::Refused([&] {
    const CsvTable t = CsvTable::Parse(fuzz::Text(data, size), "log.csv");
    for (std::size_t row = 0; row < t.rows(); ++row) {
      for (const std::string& column : t.columns()) {
        fuzz::Refused([&] {
          if (!(std::abs(t.Number(row, column)) <= CsvTable::kLargest)) std::abort();
        });
        fuzz::Refused([&] { t.NumberOrNan(row, column); });
        fuzz::Refused([&] { t.Flag(row, column); });
      }
    }
  });
}

}  // namespace continuum
