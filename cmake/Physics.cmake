# A journal of trials is worth something only for the code that ran them. rift_physics_version(TARGET
# room...) gives TARGET the definition of PhysicsVersion(): a hash of the sources of those rooms,
# made anew whenever one of them changes.
function(rift_physics_version target)
  set(sources "")
  foreach(room IN LISTS ARGN)
    file(GLOB room_sources CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/src/${room}/*.?pp"
         "${PROJECT_SOURCE_DIR}/include/rift/${room}/*.hpp")
    list(APPEND sources ${room_sources})
  endforeach()
  set(generated "${PROJECT_BINARY_DIR}/generated/physics_version.cpp")
  list(JOIN sources "\n" listed)
  file(WRITE "${generated}.list.new" "${listed}")
  file(COPY_FILE "${generated}.list.new" "${generated}.list" ONLY_IF_DIFFERENT)
  add_custom_command(
    OUTPUT "${generated}"
    COMMAND "${CMAKE_COMMAND}" "-DLIST=${generated}.list" "-DOUTPUT=${generated}"
            -P "${PROJECT_SOURCE_DIR}/cmake/HashSources.cmake"
    DEPENDS ${sources} "${generated}.list" "${PROJECT_SOURCE_DIR}/cmake/HashSources.cmake"
    VERBATIM)
  target_sources(${target} PRIVATE "${generated}")
endfunction()
