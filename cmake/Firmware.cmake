# The robot's listener is tested under MicroPython's WebAssembly build, which npm brings into the
# build folder. Without npm, or where it reaches nothing, the tests of the firmware say so and are
# skipped.
function(rift_firmware_runner target)
  set(folder "${PROJECT_BINARY_DIR}/micropython")
  set(source "${PROJECT_SOURCE_DIR}/tests/firmware")
  add_custom_command(
    OUTPUT "${folder}/installed"
    COMMAND "${CMAKE_COMMAND}" -DSOURCE=${source} -DFOLDER=${folder}
            -P "${PROJECT_SOURCE_DIR}/cmake/InstallMicroPython.cmake"
    DEPENDS "${source}/package.json" "${source}/package-lock.json"
    COMMENT "Fetching MicroPython for the tests of the robot's listener"
    VERBATIM)
  add_custom_target(${target}_micropython DEPENDS "${folder}/installed")
  add_dependencies(${target} ${target}_micropython)
endfunction()
