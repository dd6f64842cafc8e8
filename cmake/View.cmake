# The pictures of the moving robot: src/view/picture as the module lib/rift/librift_view.so, which
# rift opens only for --view and --video, since OpenCV's libraries cost every start 0.12 s. Of
# the rooms it links only `module`.
function(rift_view_module)
  file(GLOB sources CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/src/view/picture/*.cpp")
  list(REMOVE_ITEM sources "${PROJECT_SOURCE_DIR}/src/view/picture/module.cpp")
  add_library(rift_view_picture STATIC ${sources})
  set_target_properties(rift_view_picture PROPERTIES POSITION_INDEPENDENT_CODE ON)
  target_include_directories(rift_view_picture PUBLIC "${PROJECT_SOURCE_DIR}/include")
  target_link_libraries(rift_view_picture
    PUBLIC Eigen3::Eigen opencv_core
    PRIVATE rift_fmt opencv_imgproc opencv_highgui opencv_videoio rift_module)
  rift_compile_options(rift_view_picture)

  add_library(rift_view_module MODULE "${PROJECT_SOURCE_DIR}/src/view/picture/module.cpp")
  set_target_properties(rift_view_module PROPERTIES
    OUTPUT_NAME rift_view
    LIBRARY_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/lib/rift"
    CXX_VISIBILITY_PRESET hidden)
  target_link_libraries(rift_view_module PRIVATE rift_view_picture)
  target_link_options(rift_view_module PRIVATE -Wl,--no-undefined)
  rift_compile_options(rift_view_module)
  install(TARGETS rift_view_module DESTINATION lib/rift)
endfunction()
