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

# A Catch2 program of a room's tests, each test case known to CTest by its sentence.
function(rift_test_program program room sources libraries)
  add_executable(${program} ${sources})
  set_target_properties(${program} PROPERTIES
                        RUNTIME_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/tests")
  target_link_libraries(${program} PRIVATE rift_test_support ${libraries})
  rift_compile_options(${program})
  catch_discover_tests(${program} TEST_PREFIX "${room}: "
                       PROPERTIES TIMEOUT 1200 SKIP_REGULAR_EXPRESSION "SKIPPED:")
endfunction()

# rift_room_test(NAME [LIBRARIES target...] [SLOW_START test...]): every tests/NAME/*_test.cpp, and
# those of the folders in it, in the program rift_NAME_test; those of SLOW_START (without _test.cpp)
# in rift_NAME_slow_start_test. They are the ones that link OpenCV's libraries for picture files,
# videos and devices, which bring 220 others: 0.13 s of computing in the start of each test case.
function(rift_room_test name)
  cmake_parse_arguments(ARG "" "" "LIBRARIES;SLOW_START" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/tests/${name}/*_test.cpp"
    "${PROJECT_SOURCE_DIR}/tests/${name}/*/*_test.cpp")
  if(NOT sources)
    return()
  endif()
  if(ARG_SLOW_START)
    list(TRANSFORM ARG_SLOW_START REPLACE "(.+)" "${PROJECT_SOURCE_DIR}/tests/${name}/\\1_test.cpp")
    list(REMOVE_ITEM sources ${ARG_SLOW_START})
    rift_test_program(rift_${name}_slow_start_test ${name} "${ARG_SLOW_START}" "${ARG_LIBRARIES}")
  endif()
  rift_test_program(rift_${name}_test ${name} "${sources}" "${ARG_LIBRARIES}")
endfunction()

# rift_tests_need(TARGET room...): what the tests of these rooms run is built before them.
function(rift_tests_need target)
  foreach(room IN LISTS ARGN)
    foreach(program rift_${room}_test rift_${room}_slow_start_test)
      if(TARGET ${program})
        add_dependencies(${program} ${target})
      endif()
    endforeach()
  endforeach()
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
