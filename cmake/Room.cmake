# One set of warnings for everything that is compiled here. GCC 12 warns of every member that a
# designated initialiser leaves at its default, which is what defaults are for, and its -Wrestrict
# sees overlaps in std::string's operator+ that are not there (GCC bug 105651).
function(rift_compile_options target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor
    -Wcast-qual -Wconversion -Wno-sign-conversion
    -Wno-missing-field-initializers $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>)
  if(RIFT_WARNINGS_AS_ERRORS)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
endfunction()

# rift_room(NAME [ROOMS room...] [OPTIONS room...] [LIBRARIES target...] [PRIVATE_LIBRARIES target...])
# A room is src/NAME with its public headers in include/rift/NAME: the static library rift_NAME
# (with _ for /), which links the rooms it may include.
function(rift_room name)
  cmake_parse_arguments(ARG "" "" "ROOMS;OPTIONS;LIBRARIES;PRIVATE_LIBRARIES" ${ARGN})
  set(RIFT_ROOMS ${RIFT_ROOMS} ${name} PARENT_SCOPE)
  list(JOIN ARG_ROOMS " " rooms)
  list(JOIN ARG_OPTIONS " " options)
  file(APPEND "${PROJECT_BINARY_DIR}/generated/rooms.txt" "${name}: ${rooms}; ${options}\n")
  string(REPLACE "/" "_" target "rift_${name}")
  set(linked ${ARG_ROOMS} ${ARG_OPTIONS})
  list(TRANSFORM linked PREPEND rift_)
  list(TRANSFORM linked REPLACE "/" "_")
  file(GLOB sources CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/src/${name}/*.cpp")
  add_library(${target} STATIC ${sources})
  target_include_directories(${target} PUBLIC "$<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>"
                             "$<INSTALL_INTERFACE:include>")
  target_link_libraries(${target} PUBLIC ${linked} ${ARG_LIBRARIES} PRIVATE ${ARG_PRIVATE_LIBRARIES})
  rift_compile_options(${target})
endfunction()

# rift_room_test(NAME [LIBRARIES target...]): every tests/NAME/*_test.cpp, and those of the folders in
# it, in one Catch2 program, each test case known to CTest by its sentence.
function(rift_room_test name)
  cmake_parse_arguments(ARG "" "" "LIBRARIES" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/tests/${name}/*_test.cpp"
    "${PROJECT_SOURCE_DIR}/tests/${name}/*/*_test.cpp")
  if(NOT sources)
    return()
  endif()
  add_executable(rift_${name}_test ${sources})
  set_target_properties(rift_${name}_test PROPERTIES
                        RUNTIME_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/tests")
  target_link_libraries(rift_${name}_test PRIVATE rift_test_support ${ARG_LIBRARIES})
  rift_compile_options(rift_${name}_test)
  catch_discover_tests(rift_${name}_test TEST_PREFIX "${name}: "
                       PROPERTIES TIMEOUT 1200 SKIP_REGULAR_EXPRESSION "SKIPPED:")
endfunction()

# rift_benchmark(NAME target...): tests/benchmarks/NAME_benchmark.cpp with Google Benchmark.
function(rift_benchmark name)
  add_executable(${name}_benchmark ${name}_benchmark.cpp)
  set_target_properties(${name}_benchmark PROPERTIES
                        RUNTIME_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/benchmarks")
  target_include_directories(${name}_benchmark PRIVATE "${PROJECT_SOURCE_DIR}/tests")
  target_link_libraries(${name}_benchmark PRIVATE benchmark::benchmark ${ARGN})
  rift_compile_options(${name}_benchmark)
endfunction()
