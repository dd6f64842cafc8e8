# What `rift --version` tells: rift_version(TARGET) gives TARGET the definition of VersionText(), with
# the commit at the time of the build and the versions that CMake found.
function(rift_version target)
  set(libraries
    "AprilTag ${APRILTAG_VERSION}, Boost ${Boost_VERSION}, CLI11 ${CLI11_VERSION}, curl ${CURL_VERSION_STRING}, Eigen ${Eigen3_VERSION}"
    "fmt ${fmt_VERSION}, nlohmann_json ${nlohmann_json_VERSION}, NLopt ${NLOPT_VERSION}, ODE ${ODE_VERSION}, OpenCV ${OpenCV_VERSION} (rift-camera)"
    "libpng ${PNG_VERSION_STRING}, SQLite ${SQLITE_VERSION}, yaml-cpp ${yaml-cpp_VERSION}")
  list(JOIN libraries ",\\n           " libraries)
  set(generated "${PROJECT_BINARY_DIR}/generated/version.cpp")
  add_custom_target(${target}_version
    COMMAND "${CMAKE_COMMAND}" "-DOUTPUT=${generated}" "-DSOURCE=${PROJECT_SOURCE_DIR}"
            "-DVERSION=${PROJECT_VERSION}" "-DLIBRARIES=${libraries}"
            "-DCOMPILER=${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION}, ${CMAKE_BUILD_TYPE}"
            -P "${PROJECT_SOURCE_DIR}/cmake/WriteVersion.cmake"
    BYPRODUCTS "${generated}"
    VERBATIM)
  target_sources(${target} PRIVATE "${generated}")
  target_include_directories(${target} PRIVATE "${PROJECT_SOURCE_DIR}/src/commands")
  add_dependencies(${target} ${target}_version)
endfunction()
