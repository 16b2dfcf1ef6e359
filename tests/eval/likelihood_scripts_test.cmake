# SPDX-License-Identifier: MIT
# Runs eval/calibrate_likelihood.py, with and without --reliability, on a scene or two:
# cmake -DPYTHON= -DEVAL= -DBINARY= -DFOLDER= -P. Says so and passes where Python or
# what they import is missing.
execute_process(COMMAND "${PYTHON}" -c "import numpy, scipy" RESULT_VARIABLE status
  OUTPUT_QUIET ERROR_QUIET)
if(NOT status EQUAL 0)
  message("Skipped: Python with numpy and scipy is not here.")
  return()
endif()
file(REMOVE_RECURSE ${FOLDER})

function(expect_match pattern script)
  execute_process(COMMAND ${PYTHON} ${EVAL}/${script} --binary ${BINARY} --work ${FOLDER} --quick
    ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE out ERROR_VARIABLE err)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "status ${status}: ${err}")
  endif()
  if(NOT out MATCHES "${pattern}")
    message(FATAL_ERROR "expected ${pattern} in\n${out}")
  endif()
endfunction()

expect_match("edge_widths = {[0-9.]+, [0-9.]+, [0-9.]+, [0-9.]+};" calibrate_likelihood.py)
expect_match("Brier score 0\\.[0-9]+" calibrate_likelihood.py --reliability)
