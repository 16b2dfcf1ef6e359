# SPDX-License-Identifier: MIT
# Writes the commit of the sources as a header, anew only if it is another one:
# cmake -DSOURCE= -DHEADER= -P. Archives of the repository carry it in the line below.
cmake_policy(VERSION 3.25)
set(archived "$Format:%h$")
execute_process(COMMAND git describe --always --dirty --abbrev=10 --exclude=*
  WORKING_DIRECTORY ${SOURCE} OUTPUT_VARIABLE commit ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
if(NOT commit AND NOT archived MATCHES "Format")
  set(commit ${archived})
endif()
file(CONFIGURE OUTPUT ${HEADER} CONTENT "#define SKETCHSPLAT_COMMIT \"@commit@\"\n" @ONLY)
