# Runs a program that tests/same_bits/on_threads.hpp was read before on 1, 2, 3 and 8 threads: its last line, of all bits, must be one.
foreach(threads 1 2 3 8)
  execute_process(COMMAND ${CMAKE_COMMAND} -E env DELASSUS_TEST_THREADS=${threads} ${program} ${arguments}
    RESULT_VARIABLE status OUTPUT_VARIABLE text ERROR_VARIABLE errors)
  if(NOT status EQUAL 0 OR NOT text MATCHES "([1-9][0-9]* steps, bits [0-9a-f]+)\n$")
    message(FATAL_ERROR "with ${threads} threads ${program} ended with ${status} and said:\n${text}${errors}")
  endif()
  if(threads EQUAL 1)
    set(one "${CMAKE_MATCH_1}")
  elseif(NOT CMAKE_MATCH_1 STREQUAL one)
    message(FATAL_ERROR "with ${threads} threads ${program} made ${CMAKE_MATCH_1}, with one ${one}")
  endif()
endforeach()
message("${one}")
