# Precompiles the umbrella header for the programs of this folder that start with it.
#   cmake -DCOMPILER=g++ -DIS_CLANG=<bool> -DINCLUDE=<dir> -DSYSTEM=<dirs> -DPRECOMPILED=<dir> -P precompile.cmake
cmake_minimum_required(VERSION 3.25)

list(FILTER SYSTEM EXCLUDE REGEX "^$")
list(TRANSFORM SYSTEM PREPEND "-isystem")
set(source ${PRECOMPILED}/umbrella.hpp)
file(WRITE ${source} "#include <delassus/delassus.hpp>\n")
if(IS_CLANG)
  set(result ${source}.pch)
else()
  set(result ${source}.gch)
endif()
execute_process(COMMAND ${COMPILER} -std=c++20 -I${INCLUDE} ${SYSTEM} -x c++-header ${source} -o ${result}
  COMMAND_ERROR_IS_FATAL ANY)
