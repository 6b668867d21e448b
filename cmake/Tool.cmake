# continuum_tool(<name> <source> <library>...) adds a program that is run by hand. It is built by its
# name or with all others by the target continuum_tools, not by default. What takes time at run time
# is in the libraries.
add_custom_target(continuum_tools)

function(continuum_tool name source)
  add_executable(${name} EXCLUDE_FROM_ALL ${source})
  target_link_libraries(${name} PRIVATE continuum_warnings CLI11::CLI11 fmt::fmt ${ARGN})
  target_compile_options(${name} PRIVATE $<$<CONFIG:Release>:-O1>)
  add_dependencies(continuum_tools ${name})
endfunction()
