# Compiles one example with a compiler of another platform, runs it, and expects what its second line, `// prints: <regex>`, says.
cmake_minimum_required(VERSION 3.25)

cmake_path(GET PROGRAM PARENT_PATH folder)
file(MAKE_DIRECTORY ${folder})
list(TRANSFORM SYSTEM PREPEND "-isystem")
execute_process(COMMAND ${COMPILER} -std=c++20 -O1 ${FLAGS} -I${INCLUDE} ${SYSTEM} ${SOURCE} -o ${PROGRAM}
  COMMAND_ERROR_IS_FATAL ANY)
if(COMPILE_ONLY)
  return()
endif()
execute_process(COMMAND ${RUN} ${PROGRAM} OUTPUT_VARIABLE printed COMMAND_ERROR_IS_FATAL ANY)
file(STRINGS ${SOURCE} prints REGEX "^// prints: " LIMIT_COUNT 1)
string(REGEX REPLACE "^// prints: " "" regex "${prints}")
if(NOT printed MATCHES "${regex}")
  message(FATAL_ERROR "${SOURCE} should print '${regex}', it printed\n${printed}")
endif()
