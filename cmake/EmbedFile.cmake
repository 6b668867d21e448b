# continuum_embed(<target> <namespace> <name> <file>) compiles the bytes of <file> into <target> as
#   namespace <namespace> { extern const std::string_view <name>; }
# Run as a script (cmake -P) this file is its own generator, so that the target is rebuilt when the
# embedded file changes.
if(CMAKE_SCRIPT_MODE_FILE STREQUAL CMAKE_CURRENT_LIST_FILE)
  file(READ "${INPUT}" _bytes HEX)
  string(REGEX REPLACE "(..)" "'\\\\x\\1'," _bytes "${_bytes}")
  file(WRITE "${OUTPUT}" "#include <string_view>

namespace ${NAMESPACE} {
namespace {
constexpr char kBytes[] = {${_bytes}'\\0'};
}
extern const std::string_view ${NAME};
constinit const std::string_view ${NAME}(kBytes, sizeof(kBytes) - 1);
}  // namespace ${NAMESPACE}
")
  return()
endif()

set(CONTINUUM_EMBED_SCRIPT ${CMAKE_CURRENT_LIST_FILE})

function(continuum_embed target namespace name file)
  get_filename_component(_input ${file} ABSOLUTE)
  if(NOT EXISTS ${_input})
    message(FATAL_ERROR "continuum_embed: ${_input} does not exist")
  endif()
  set(_output ${CMAKE_CURRENT_BINARY_DIR}/embedded/${name}.cc)
  add_custom_command(OUTPUT ${_output}
    COMMAND ${CMAKE_COMMAND} -DINPUT=${_input} -DOUTPUT=${_output} -DNAMESPACE=${namespace}
            -DNAME=${name} -P ${CONTINUUM_EMBED_SCRIPT}
    DEPENDS ${_input} ${CONTINUUM_EMBED_SCRIPT}
    COMMENT "Embedding ${file}" VERBATIM)
  target_sources(${target} PRIVATE ${_output})
endfunction()
