# ccache makes a second build of the same sources take seconds; without it the build just works.
find_program(RIFT_CCACHE ccache)
if(RIFT_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER "${RIFT_CCACHE}")
endif()
