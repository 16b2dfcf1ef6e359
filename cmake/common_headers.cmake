# SPDX-License-Identifier: MIT
# Headers that most files read, compiled once. Files name what they need all the same: without
# SKETCHSPLAT_COMMON_HEADERS they have to.
option(SKETCHSPLAT_COMMON_HEADERS "Compile headers that most files read once (precompiled)" ON)

set(common_headers
  <Eigen/Core> <Eigen/Geometry>
  <algorithm> <array> <cmath> <cstdint> <cstdio> <filesystem> <fstream> <functional> <limits> <map>
  <memory> <numeric> <optional> <set> <sstream> <stdexcept> <string> <utility> <vector>)

# add_common_headers(name HEADERS... LIBS...): a target whose headers others use by use_common_headers. GCC
# asks for the same -fPIC and -fopenmp of both.
function(add_common_headers name)
  cmake_parse_arguments(H "" "" "HEADERS;LIBS" ${ARGN})
  file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/generated/${name}.cc CONTENT "// Headers alone.\n")
  add_library(${name} OBJECT ${CMAKE_BINARY_DIR}/generated/${name}.cc)
  target_link_libraries(${name} PRIVATE Eigen3::Eigen OpenMP::OpenMP_CXX ${H_LIBS})
  target_precompile_headers(${name} PRIVATE ${H_HEADERS})
endfunction()

# use_common_headers(target name): `target` has to link Eigen and OpenMP, as all that link
# datasets_types do.
function(use_common_headers target name)
  if(SKETCHSPLAT_COMMON_HEADERS)
    target_precompile_headers(${target} REUSE_FROM ${name})
  endif()
endfunction()
