# SPDX-License-Identifier: MIT
# eval/batch_throughput.py on two scenes: what it prints, not how fast these are, and that results of
# both ways are there: cmake -DPYTHON= -DSCRIPT= -DBINARY= -DFOLDER= -P. Says so and passes where
# Python is missing.
if(NOT PYTHON)
  message("Skipped: Python is not here.")
  return()
endif()
file(REMOVE_RECURSE ${FOLDER})
execute_process(COMMAND ${PYTHON} ${SCRIPT} ${BINARY} --work ${FOLDER} --scenes 2 --jobs 1 2
  RESULT_VARIABLE status OUTPUT_VARIABLE out ERROR_VARIABLE err)
foreach(jobs 1 2)
  if(NOT status MATCHES "^[01]$" OR
     NOT out MATCHES "2 scenes, ${jobs} at a time: batch [0-9.]+ s, [0-9]+ a core and minute; by hand ")
    message(FATAL_ERROR "status ${status}: ${out}${err}")
  endif()
endforeach()
foreach(result batch/s0 batch/s1 hand/s0 hand/s1)
  if(NOT EXISTS ${FOLDER}/${result}/sketch.json)
    message(FATAL_ERROR "expected ${result}/sketch.json")
  endif()
endforeach()
