# The CMake package mujoco_continuum and the robots, beside the plugin, the executable and the laws:
#   find_package(mujoco_continuum 0.1 REQUIRED)
#   continuum::effects         the laws, headers that need nothing
#   continuum::plugin          the plugin, to be loaded: $<TARGET_FILE:continuum::plugin>
#   continuum::sim             experiments, logs, simulation, replay, checks
#   continuum::identification  fit and diagnosis
# The last two, static libraries with their headers, are the component "libraries": a wheel goes
# without.
include(CMakePackageConfigHelpers)
set(_package lib/cmake/mujoco_continuum)
configure_package_config_file(
  ${PROJECT_SOURCE_DIR}/cmake/mujoco_continuum-config.cmake.in
  ${PROJECT_BINARY_DIR}/mujoco_continuum-config.cmake
  INSTALL_DESTINATION ${_package})
configure_file(${PROJECT_SOURCE_DIR}/cmake/mujoco_continuum-libraries.cmake.in
  ${PROJECT_BINARY_DIR}/mujoco_continuum-libraries.cmake @ONLY)
write_basic_package_version_file(
  ${PROJECT_BINARY_DIR}/mujoco_continuum-config-version.cmake COMPATIBILITY SameMinorVersion)
install(EXPORT mujoco_continuum NAMESPACE continuum:: FILE mujoco_continuum-targets.cmake
  DESTINATION ${_package})
install(FILES
  ${PROJECT_BINARY_DIR}/mujoco_continuum-config.cmake
  ${PROJECT_BINARY_DIR}/mujoco_continuum-config-version.cmake
  ${PROJECT_SOURCE_DIR}/cmake/FindMuJoCo.cmake
  DESTINATION ${_package})
foreach(_library engine sim identification)
  set_target_properties(continuum_${_library} PROPERTIES EXPORT_NAME ${_library})
  install(TARGETS continuum_${_library} EXPORT mujoco_continuum_libraries
    ARCHIVE DESTINATION lib COMPONENT libraries)
endforeach()
install(EXPORT mujoco_continuum_libraries NAMESPACE continuum:: DESTINATION ${_package}
  FILE mujoco_continuum-libraries-targets.cmake COMPONENT libraries)
install(FILES ${PROJECT_BINARY_DIR}/mujoco_continuum-libraries.cmake DESTINATION ${_package}
  COMPONENT libraries)
install(DIRECTORY sim identification DESTINATION include/mujoco_continuum COMPONENT libraries
  FILES_MATCHING PATTERN *.h)
install(DIRECTORY plugin/ DESTINATION include/mujoco_continuum/plugin COMPONENT libraries
  FILES_MATCHING PATTERN *.h PATTERN effects EXCLUDE)
install(FILES LICENSE DESTINATION share/mujoco_continuum)
if(CONTINUUM_OWN_MUJOCO)
  install(FILES ${MuJoCo_LIBRARY} DESTINATION lib)
  get_filename_component(_mujoco ${MuJoCo_LIBRARY} DIRECTORY)
  file(GLOB _licenses ${_mujoco}/../mujoco_core-*.dist-info/licenses/*)
  install(FILES ${_licenses} DESTINATION share/mujoco_continuum/licenses/mujoco)
endif()
install(DIRECTORY models DESTINATION share/mujoco_continuum FILES_MATCHING
  PATTERN *.xml PATTERN *.yaml PATTERN *.csv PATTERN README.md PATTERN import.py
  PATTERN importer.py
  PATTERN mjcf EXCLUDE PATTERN images EXCLUDE PATTERN statics EXCLUDE)
