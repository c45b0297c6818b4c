# Compiles one wrong program and checks that it fails with exactly one error, which says the sentence it announces.
#   cmake -DSOURCE=x.cpp -DCOMPILER=g++ -DINCLUDE=<dir> -DSYSTEM=<dirs> [-DPRECOMPILED=<dir>] -P expect_error.cmake
# The first line of the program reads `// expect: <sentence>`; the sentence is plain text, found as it stands.
#
# A program whose first include is the umbrella starts from it precompiled, as precompile.cmake left it: nearly all of its time.
cmake_minimum_required(VERSION 3.25)

# A NOTICE keeps its lines as they are; FATAL_ERROR would wrap them.
function(complain text)
  message(NOTICE "${SOURCE}: ${text}")
  message(FATAL_ERROR "The program is not wrong in the way it says.")
endfunction()

file(STRINGS ${SOURCE} first_line LIMIT_COUNT 1)
if(NOT first_line MATCHES "^// expect: (.+)$")
  complain("its first line is not `// expect: <sentence>`")
endif()
string(REPLACE "\\;" ";" sentence "${CMAKE_MATCH_1}")  # file(STRINGS) makes a list, and escapes for it

list(FILTER SYSTEM EXCLUDE REGEX "^$")
list(TRANSFORM SYSTEM PREPEND "-isystem")
set(head_start "")
file(STRINGS ${SOURCE} includes REGEX "^#include ")
if(PRECOMPILED AND includes MATCHES "^#include <delassus/delassus.hpp>")
  if(EXISTS ${PRECOMPILED}/umbrella.hpp.pch)
    set(head_start -include-pch ${PRECOMPILED}/umbrella.hpp.pch)
  else()
    set(head_start -include ${PRECOMPILED}/umbrella.hpp -Winvalid-pch)
  endif()
endif()
set(ENV{LC_ALL} C)
macro(compile)
  execute_process(COMMAND ${COMPILER} -std=c++20 -fsyntax-only -I${INCLUDE} ${SYSTEM} ${ARGN} ${SOURCE}
    RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
endmacro()
compile(${head_start})
# After an error clang 14 may fall over what it reads from the precompiled header.
if(head_start AND output MATCHES "crash backtrace")
  compile()
endif()
if(status EQUAL 0)
  complain("it compiles, but should say: ${sentence}")
endif()

string(REGEX MATCHALL " error: " errors "${output}")
list(LENGTH errors count)
if(NOT count EQUAL 1)
  complain("${count} errors instead of one:\n${output}")
endif()
string(FIND "${output}" "${sentence}" place)
if(place EQUAL -1)
  complain("the sentence is missing: ${sentence}\n${output}")
endif()
