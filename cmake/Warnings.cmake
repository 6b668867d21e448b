# What every target of ours is compiled with. GCC 14 takes what Eigen frees for uninitialised.
set(_newer_gcc $<AND:$<CXX_COMPILER_ID:GNU>,$<VERSION_GREATER_EQUAL:$<CXX_COMPILER_VERSION>,13>>)
add_library(continuum_warnings INTERFACE)
target_compile_options(continuum_warnings INTERFACE
  -Wall -Wextra -Wpedantic -Wconversion -Wno-sign-conversion
  $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict> $<${_newer_gcc}:-Wno-maybe-uninitialized>
  $<$<BOOL:${CONTINUUM_WERROR}>:-Werror>)
