# The camera side needs OpenCV, whose libraries cost every start 0.1 s, so rift itself links none of
# it: the room (src/vision/*.cpp) is linked by its tests and by the module lib/rift/librift_vision.so,
# which rift opens only for `track` and `drive`. What rift links of the room, the opening of the
# module included, is src/vision/plain/*.cpp: the library rift_vision_plain.
function(rift_vision_module)
  set_target_properties(rift_geometry rift_vision PROPERTIES POSITION_INDEPENDENT_CODE ON)

  # The loops over pixels, in debug builds too: else the twin's camera takes 7 pictures a second.
  foreach(loop flat_painter flat_pattern ray_tiles)
    set_source_files_properties("${PROJECT_SOURCE_DIR}/src/vision/${loop}.cpp" PROPERTIES
                                COMPILE_OPTIONS "$<$<CONFIG:Debug>:-O2>")
  endforeach()

  file(GLOB plain CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/src/vision/plain/*.cpp")
  if(plain)
    add_library(rift_vision_plain STATIC ${plain})
    set_target_properties(rift_vision_plain PROPERTIES POSITION_INDEPENDENT_CODE ON)
    target_link_libraries(rift_vision_plain PUBLIC rift_geometry PRIVATE rift_module)
    rift_compile_options(rift_vision_plain)
    target_link_libraries(rift_vision PUBLIC rift_vision_plain)
  endif()

  file(GLOB module CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/src/vision/module/*.cpp")
  if(NOT module)
    return()
  endif()
  add_library(rift_vision_module MODULE ${module})
  set_target_properties(rift_vision_module PROPERTIES
    OUTPUT_NAME rift_vision
    LIBRARY_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/lib/rift"
    CXX_VISIBILITY_PRESET hidden)
  target_link_libraries(rift_vision_module PRIVATE rift_vision rift_fmt)
  target_link_options(rift_vision_module PRIVATE -Wl,--no-undefined)
  rift_compile_options(rift_vision_module)
  add_dependencies(rift rift_vision_module)
  install(TARGETS rift_vision_module DESTINATION lib/rift)
endfunction()
