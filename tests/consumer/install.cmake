# Installs BUILD into a new PREFIX, so that nothing is left of an earlier installation. It is installed
# elsewhere and moved: no file may name the place where it was, nor the build tree.
file(REMOVE_RECURSE ${PREFIX} ${PREFIX}-before)
execute_process(COMMAND ${CMAKE_COMMAND} --install ${BUILD} --prefix ${PREFIX}-before
  OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
file(RENAME ${PREFIX}-before ${PREFIX})
file(GLOB _files ${PREFIX}/lib/cmake/mujoco_continuum/*)
foreach(_file IN LISTS _files)
  file(STRINGS ${_file} _places REGEX "${PREFIX}|${BUILD}")
  if(_places)
    message(FATAL_ERROR "${_file} names the place where it was made: ${_places}")
  endif()
endforeach()
