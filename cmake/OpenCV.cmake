# The six modules of OpenCV that rift uses, from Debian's split packages. libopencv-dev would bring
# OpenCVConfig.cmake, and with it every module and 341 MB more.
find_path(OpenCV_INCLUDE_DIR opencv2/core/version.hpp PATH_SUFFIXES opencv4 REQUIRED)
file(STRINGS "${OpenCV_INCLUDE_DIR}/opencv2/core/version.hpp" lines
     REGEX "define CV_VERSION_(MAJOR|MINOR|REVISION) ")
string(REGEX REPLACE "[^0-9]+([0-9]+)[^0-9]+([0-9]+)[^0-9]+([0-9]+).*" "\\1.\\2.\\3"
       OpenCV_VERSION "${lines}")
if(OpenCV_VERSION VERSION_LESS 4.6)
  message(FATAL_ERROR "OpenCV ${OpenCV_VERSION} in ${OpenCV_INCLUDE_DIR}: 4.6 or later is needed")
endif()
foreach(module core flann features2d imgproc calib3d imgcodecs videoio highgui)
  find_library(OpenCV_${module}_LIBRARY opencv_${module} REQUIRED)
  add_library(opencv_${module} UNKNOWN IMPORTED)
  set_target_properties(opencv_${module} PROPERTIES
                        IMPORTED_LOCATION "${OpenCV_${module}_LIBRARY}"
                        INTERFACE_INCLUDE_DIRECTORIES "${OpenCV_INCLUDE_DIR}")
endforeach()
