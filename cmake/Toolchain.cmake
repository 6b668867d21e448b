# What makes a build fast where it is installed, and is not required: ccache and lld.
find_program(CCACHE ccache)
if(CCACHE)  # Without this sloppiness ccache takes no source that reads a precompiled header.
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env
    CCACHE_SLOPPINESS=pch_defines,time_macros ${CCACHE})
endif()

# GCC collects garbage after every 128 MiB by default, a tenth of its time on sources like ours.
add_compile_options($<$<CXX_COMPILER_ID:GNU>:--param=ggc-min-heapsize=524288>)  # KiB

include(CheckLinkerFlag)
check_linker_flag(CXX -fuse-ld=lld CONTINUUM_HAS_LLD)
if(CONTINUUM_HAS_LLD)
  add_link_options(-fuse-ld=lld)
endif()
