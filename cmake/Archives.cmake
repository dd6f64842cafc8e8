# Archives instead of shared objects: finding the symbols of yaml-cpp, ODE and libpng at every start
# took 0.7 of the 2.7 ms of `rift --version`, those of fmt 0.2. libstdc++ stays shared: exceptions
# and strings cross the border to the module of rift_view_module().

# rift_archive(NAME TARGET LIBRARIES library...): the interface library NAME is TARGET with these
# archives and libraries in the place of its shared object, or TARGET as it is if one is missing.
function(rift_archive name target)
  cmake_parse_arguments(ARG "" "" "LIBRARIES" ${ARGN})
  add_library(${name} INTERFACE)
  set(files "")
  foreach(library IN LISTS ARG_LIBRARIES)
    find_library(RIFT_FILE_OF_${library} NAMES ${library})
    if(NOT RIFT_FILE_OF_${library})
      message(STATUS "${library} not found: ${target} is linked as a shared object")
      target_link_libraries(${name} INTERFACE ${target})
      return()
    endif()
    list(APPEND files "${RIFT_FILE_OF_${library}}")
  endforeach()
  target_include_directories(${name} INTERFACE
    $<TARGET_PROPERTY:${target},INTERFACE_INCLUDE_DIRECTORIES>)
  target_compile_options(${name} INTERFACE $<TARGET_PROPERTY:${target},INTERFACE_COMPILE_OPTIONS>)
  target_compile_definitions(${name} INTERFACE
    $<TARGET_PROPERTY:${target},INTERFACE_COMPILE_DEFINITIONS>)
  target_link_libraries(${name} INTERFACE ${files})
endfunction()

# rift_fmt: of fmt Debian has no archive, and src/fmt.cpp makes one from its headers. In modules too.
function(rift_fmt_archive)
  add_library(rift_fmt STATIC "${PROJECT_SOURCE_DIR}/src/fmt.cpp")
  set_target_properties(rift_fmt PROPERTIES POSITION_INDEPENDENT_CODE ON)
  target_include_directories(rift_fmt PUBLIC
    $<TARGET_PROPERTY:fmt::fmt,INTERFACE_INCLUDE_DIRECTORIES>)
  target_compile_definitions(rift_fmt PUBLIC
    $<TARGET_PROPERTY:fmt::fmt,INTERFACE_COMPILE_DEFINITIONS>)
  rift_compile_options(rift_fmt)
endfunction()
