# What every target of ours is compiled with.
add_library(continuum_warnings INTERFACE)
target_compile_options(continuum_warnings INTERFACE
  -Wall -Wextra -Wpedantic -Wconversion -Wno-sign-conversion
  $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict> $<$<BOOL:${CONTINUUM_WERROR}>:-Werror>)
