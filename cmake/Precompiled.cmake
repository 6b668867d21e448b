# continuum_use_precompiled(<library>...) lets static libraries share one precompiled header: what most of
# their sources read anyway. Every source includes what it uses itself; scripts/check reads sources
# without it, as -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON does.
file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/precompiled.cc CONTENT "")  # not touched again
add_library(continuum_precompiled OBJECT ${PROJECT_BINARY_DIR}/precompiled.cc)
target_link_libraries(continuum_precompiled PRIVATE continuum_warnings fmt::fmt Eigen3::Eigen)
target_precompile_headers(continuum_precompiled PRIVATE
  <algorithm> <array> <cmath> <filesystem> <functional> <limits> <map> <memory> <numbers> <optional>
  <set> <string> <string_view> <utility> <vector> <Eigen/Dense> <fmt/format.h>)

# What compiling with a precompiled header of <string> takes. clang writes the time of every header
# into it; a compiler cache that serves several checkouts must not compare it. GCC 12 finds overflows
# in string::replace that are none (its bugs 105329 and 105651), as -Wno-restrict silences otherwise.
function(continuum_precompiled_options target)
  target_compile_options(${target} PRIVATE
    $<$<CXX_COMPILER_ID:Clang>:SHELL:-Xclang -fno-pch-timestamp>
    "$<$<CXX_COMPILER_ID:GNU>:-Wno-array-bounds;-Wno-stringop-overflow>")
endfunction()
continuum_precompiled_options(continuum_precompiled)

function(continuum_use_precompiled)
  foreach(_library IN LISTS ARGN)
    target_link_libraries(${_library} PRIVATE fmt::fmt)  # its macros are those of the header
    target_precompile_headers(${_library} REUSE_FROM continuum_precompiled)
    continuum_precompiled_options(${_library})
  endforeach()
endfunction()
