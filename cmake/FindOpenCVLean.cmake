# SPDX-License-Identifier: MIT
# OpenCV's core and imgproc only: Debian ships OpenCVConfig.cmake solely with the 1 GB meta package.
find_path(OpenCVLean_INCLUDE_DIR opencv2/core.hpp PATH_SUFFIXES opencv4)
find_library(OpenCVLean_CORE opencv_core)
find_library(OpenCVLean_IMGPROC opencv_imgproc)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(
  OpenCVLean REQUIRED_VARS OpenCVLean_INCLUDE_DIR OpenCVLean_CORE OpenCVLean_IMGPROC)
if(OpenCVLean_FOUND AND NOT TARGET opencv::lean)
  add_library(opencv::lean INTERFACE IMPORTED)
  target_include_directories(opencv::lean SYSTEM INTERFACE ${OpenCVLean_INCLUDE_DIR})
  target_link_libraries(opencv::lean INTERFACE ${OpenCVLean_IMGPROC} ${OpenCVLean_CORE})
endif()
