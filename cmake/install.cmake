# SPDX-License-Identifier: MIT
# What is installed, and where; and the Debian package that `cpack -G DEB` makes of it.
include(GNUInstallDirs)

# The program looks for what it loads in ../lib/sketchsplat beside itself: see plugin_path.cc.
install(TARGETS sketchsplat RUNTIME DESTINATION bin COMPONENT program)
install(TARGETS sketchsplat_brep sketchsplat_image_formats sketchsplat_synthesis
  LIBRARY DESTINATION lib/sketchsplat COMPONENT program)

# The library for programs of others: find_package(sketchsplat), sketchsplat::sketchsplat.
include(CMakePackageConfigHelpers)
install(TARGETS sketchsplat_library EXPORT sketchsplat_targets
  LIBRARY DESTINATION lib COMPONENT library)
install(TARGETS sketchsplat_brep sketchsplat_image_formats
  LIBRARY DESTINATION lib/sketchsplat COMPONENT library)
install(DIRECTORY include/sketchsplat DESTINATION include COMPONENT library)
install(EXPORT sketchsplat_targets FILE sketchsplatTargets.cmake NAMESPACE sketchsplat::
  DESTINATION lib/cmake/sketchsplat COMPONENT library)
configure_package_config_file(cmake/sketchsplatConfig.cmake.in
  ${CMAKE_BINARY_DIR}/generated/sketchsplatConfig.cmake
  INSTALL_DESTINATION lib/cmake/sketchsplat)
write_basic_package_version_file(${CMAKE_BINARY_DIR}/generated/sketchsplatConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/generated/sketchsplatConfig.cmake
  ${CMAKE_BINARY_DIR}/generated/sketchsplatConfigVersion.cmake
  DESTINATION lib/cmake/sketchsplat COMPONENT library)
if(TARGET sketchsplat_python)
  install(TARGETS sketchsplat_python LIBRARY DESTINATION ${SKETCHSPLAT_PYTHON_FOLDER}
    COMPONENT library)
endif()

# ./run package makes the manual page.
install(FILES ${CMAKE_BINARY_DIR}/package/sketchsplat.1.gz DESTINATION share/man/man1
  COMPONENT program OPTIONAL)
install(FILES README.md LICENSE OPTIONS.md CHANGELOG.md cmake/copyright
  DESTINATION share/doc/sketchsplat COMPONENT program)
install(DIRECTORY docs DESTINATION share/doc/sketchsplat COMPONENT program)
install(PROGRAMS eval/abc_nef_table.py DESTINATION share/sketchsplat COMPONENT program)
install(PROGRAMS eval/charts.py DESTINATION lib/sketchsplat COMPONENT program)
install(PROGRAMS scripts/slurm/array.sh scripts/slurm/merge.sh scripts/slurm/one_node.sh
  scripts/slurm/submit.sh DESTINATION share/sketchsplat/slurm COMPONENT program)

# FreeCAD finds it once it is linked to from its folder Mod: docs/freecad.md.
install(DIRECTORY freecad/ DESTINATION share/sketchsplat/freecad COMPONENT program
  PATTERN __pycache__ EXCLUDE)

set(CPACK_PACKAGE_NAME sketchsplat)
set(CPACK_PACKAGE_VENDOR "sketchsplat contributors")
set(CPACK_PACKAGE_CONTACT "sketchsplat contributors <nobody@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "edges of CAD objects from calibrated images, as exact curves")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_GENERATOR DEB)
set(CPACK_COMPONENTS_ALL program)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "colmap, freecad, slurm-wlm, parallel, python3, python3-matplotlib")
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION
  "Photographs or renderings of a CAD object with known cameras become its\n\
 edges: lines, arcs, circles, ellipses and splines that share their\n\
 corners, as STEP, OBJ and JSON. On a CPU, without training; whole folders\n\
 of scenes with one command.")
include(CPack)
