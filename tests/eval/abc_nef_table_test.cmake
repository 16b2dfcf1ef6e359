# SPDX-License-Identifier: MIT
# Runs eval/abc_nef_table.py on two scenes of one line each, of which the second has no result:
# cmake -DPYTHON= -DSCRIPT= -DBINARY= -DFOLDER= -P. Says so and passes without Python.
if(NOT PYTHON)
  message("Skipped: Python is not here.")
  return()
endif()
file(REMOVE_RECURSE ${FOLDER})
foreach(scene a b)
  file(WRITE ${FOLDER}/scenes/${scene}/groundtruth/gt.json
    [=[[{"type": "line", "points": [[0, 0, 0], [1, 0, 0]]}]]=])
endforeach()
file(WRITE ${FOLDER}/results/a.json [=[{"lines_end_pts": [[0, 0, 0, 1, 0, 0]], "curves_ctl_pts": []}]=])

function(expect_row row)
  execute_process(COMMAND ${PYTHON} ${SCRIPT} --binary ${BINARY} --gt ${FOLDER}/scenes ${ARGN}
    line_art=${FOLDER}/results RESULT_VARIABLE status OUTPUT_VARIABLE out ERROR_VARIABLE err)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "status ${status}: ${err}")
  endif()
  string(FIND "${out}" "${row}" at)
  if(at EQUAL -1)
    message(FATAL_ERROR "expected the row\n${row}\nin\n${out}")
  endif()
endfunction()

# Acc and Comp of the one that is there, half of everything else.
expect_row("| line_art | 0.1 | 1.3 | 50.0 | 50.0 | 50.0 | 50.0 | 50.0 | 50.0 | 50.0 | 50.0 | 50.0 | 0.5 | 2 (1 missing) |")
expect_row("| line_art | 0.1 | 1.3 | 100.0 | 100.0 | 100.0 | 100.0 | 100.0 | 100.0 | 100.0 | 100.0 | 100.0 | 1.0 | 1 |"
  --missing skip)
expect_row("line\\_art & 0.1 & 1.3 & 50.0" --latex)
