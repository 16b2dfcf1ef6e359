# SPDX-License-Identifier: MIT
# Runs eval/calibrate_likelihood.py, with and without --reliability, and eval/detection_curve.py on a
# scene or two: cmake -DPYTHON= -DEVAL= -DBINARY= -DFOLDER= -P. Says so and passes where Python or
# what they import is missing.
execute_process(COMMAND "${PYTHON}" -c "import cv2, numpy, scipy" RESULT_VARIABLE status
  OUTPUT_QUIET ERROR_QUIET)
if(NOT status EQUAL 0)
  message("Skipped: Python with numpy, scipy and OpenCV is not here.")
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
expect_match("\\| 220 and more \\| 12 \\| 100 \\|" detection_curve.py)  # all edges of a box
