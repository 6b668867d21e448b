// A log of MATLAB: all vectors, and the matrix of one name. Version 7.3 is HDF5, of which damaged
// files leak memory and take seconds inside that library: not tried here.
#include "fuzz/fuzz.h"
#include "sim/io/mat_file.h"

namespace continuum {
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size >= 126 && data[124] == 0 && data[125] == 2) return -1;
  const auto file = fuzz::Write("log.mat", fuzz::Text(data, size));
  for (const char* variable : {"", "x"}) {
    fuzz::Refused([&] {
      const Columns c = ReadMat(file, variable);
      if (c.names.size() != c.values.size()) std::abort();
      for (const auto& v : c.values) {
        if (v.size() != c.values.front().size()) std::abort();
      }
    });
  }
  return 0;
}

}  // namespace continuum
