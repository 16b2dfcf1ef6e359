# SPDX-License-Identifier: MIT
# Debian ships cairo without a CMake configuration.
find_path(Cairo_INCLUDE_DIR cairo.h PATH_SUFFIXES cairo)
find_library(Cairo_LIBRARY cairo)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Cairo REQUIRED_VARS Cairo_INCLUDE_DIR Cairo_LIBRARY)
if(Cairo_FOUND AND NOT TARGET cairo::cairo)
  add_library(cairo::cairo INTERFACE IMPORTED)
  target_include_directories(cairo::cairo SYSTEM INTERFACE ${Cairo_INCLUDE_DIR})
  target_link_libraries(cairo::cairo INTERFACE ${Cairo_LIBRARY})
endif()
