# Builds the test programs of one room and removes the results of earlier runs, so that
# every call of ctest runs the tests anew (deal.II's test targets would otherwise take the
# output of a test whose program and .output file have not changed for good, whatever
# became of the files that it reads).
#
#   BUILD_FOLDER  the build folder
#   TEST_FOLDER   the room's folder in it
#   TARGET        what to build

# deal.II's run_test.cmake puts a part of each test program aside between the runs of the
# test, and takes a test for interrupted, and links it again, if it finds it in its place.
file(GLOB guards ${TEST_FOLDER}/*/interrupt_guard.cc_bck)
foreach(guard ${guards})
  string(REGEX REPLACE "_bck$" "" original ${guard})
  file(RENAME ${guard} ${original})
endforeach()

file(GLOB results LIST_DIRECTORIES FALSE
     ${TEST_FOLDER}/*/output ${TEST_FOLDER}/*/diff
     ${TEST_FOLDER}/*/mpirun=*/output ${TEST_FOLDER}/*/mpirun=*/diff)
if(results)
  file(REMOVE ${results})
endif()

# As many compilers at a time as there are processors, but no more than memory allows: one
# of deal.II's larger headers takes about 1.5 GB.
set(jobs $ENV{CMAKE_BUILD_PARALLEL_LEVEL})
if(NOT jobs)
  cmake_host_system_information(RESULT jobs QUERY NUMBER_OF_LOGICAL_CORES)
  cmake_host_system_information(RESULT memory QUERY AVAILABLE_PHYSICAL_MEMORY) # MB
  math(EXPR jobs_by_memory "${memory} / 1500")
  if(jobs_by_memory LESS jobs)
    set(jobs ${jobs_by_memory})
  endif()
  if(jobs LESS 1)
    set(jobs 1)
  endif()
endif()

execute_process(
  COMMAND ${CMAKE_COMMAND} --build ${BUILD_FOLDER} --target ${TARGET} --parallel ${jobs}
  RESULT_VARIABLE result)
if(NOT result EQUAL 0)
  message(FATAL_ERROR "Building ${TARGET} failed.")
endif()

file(GLOB guards ${TEST_FOLDER}/*/interrupt_guard.cc)
foreach(guard ${guards})
  file(RENAME ${guard} ${guard}_bck)
endforeach()
