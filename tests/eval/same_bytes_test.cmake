# SPDX-License-Identifier: MIT
# eval/same_bytes.py on a small scene, with the program twice, and with one that writes a line more:
# cmake -DPYTHON= -DSCRIPT= -DBINARY= -DFOLDER= -P. Says so and passes where Python is missing.
if(NOT PYTHON)
  message("Skipped: Python is not here.")
  return()
endif()
file(REMOVE_RECURSE ${FOLDER})
execute_process(COMMAND ${BINARY} synthesize box --views 8 --resolution 160 --out ${FOLDER}/box --quiet
  OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
file(WRITE ${FOLDER}/other "#!/bin/sh\n'${BINARY}' \"$@\" && echo >>\"$4/sketch.obj\"\n")
file(CHMOD ${FOLDER}/other PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE)

function(expect_status expected pattern other)
  execute_process(COMMAND ${PYTHON} ${SCRIPT} ${BINARY} ${other} --scenes ${FOLDER}/box
    --out ${FOLDER}/results RESULT_VARIABLE status OUTPUT_VARIABLE out ERROR_VARIABLE err)
  if(NOT status EQUAL ${expected} OR NOT out MATCHES "${pattern}")
    message(FATAL_ERROR "status ${status}: ${out}${err}")
  endif()
endfunction()

expect_status(0 "box: [0-9]+ files, the same" ${BINARY})
expect_status(1 "box: [0-9]+ files, differ: sketch.obj\n" ${FOLDER}/other)
