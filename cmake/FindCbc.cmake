# SPDX-License-Identifier: MIT
# COIN-OR's solver of integer programmes, which comes without a CMake package: target Cbc::cbc.
find_path(Cbc_INCLUDE_DIR coin/Cbc_C_Interface.h)
find_library(Cbc_SOLVER CbcSolver)
find_library(Cbc_LIBRARY Cbc)
if(Cbc_INCLUDE_DIR)
  file(STRINGS ${Cbc_INCLUDE_DIR}/coin/CbcConfig.h version REGEX "define CBC_VERSION \"")
  string(REGEX REPLACE ".*\"(.*)\".*" "\\1" Cbc_VERSION "${version}")
endif()
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Cbc REQUIRED_VARS Cbc_INCLUDE_DIR Cbc_SOLVER Cbc_LIBRARY
  VERSION_VAR Cbc_VERSION)
if(Cbc_FOUND AND NOT TARGET Cbc::cbc)
  add_library(Cbc::cbc INTERFACE IMPORTED)
  set_target_properties(Cbc::cbc PROPERTIES
    INTERFACE_INCLUDE_DIRECTORIES "${Cbc_INCLUDE_DIR};${Cbc_INCLUDE_DIR}/coin"
    INTERFACE_LINK_LIBRARIES "${Cbc_SOLVER};${Cbc_LIBRARY}")
endif()
