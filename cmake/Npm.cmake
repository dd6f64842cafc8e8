# What tests need from npm is brought into the build folder: MicroPython in WebAssembly for the
# robot's listener, the physics engine Rapier for candidate.kind: program, a reader of MCAP files.
# Without npm, or where it reaches nothing, those tests say so and are skipped.
function(rift_npm_packages)
  set(folder "${PROJECT_BINARY_DIR}/npm")
  set(source "${PROJECT_SOURCE_DIR}/tests/npm")
  add_custom_command(
    OUTPUT "${folder}/installed"
    COMMAND "${CMAKE_COMMAND}" -DSOURCE=${source} -DFOLDER=${folder}
            -P "${PROJECT_SOURCE_DIR}/cmake/InstallNpm.cmake"
    DEPENDS "${source}/package.json" "${source}/package-lock.json"
    COMMENT "Fetching what tests need from npm"
    VERBATIM)
  add_custom_target(rift_npm DEPENDS "${folder}/installed")
  foreach(target IN LISTS ARGN)
    add_dependencies(${target} rift_npm)
  endforeach()
endfunction()
