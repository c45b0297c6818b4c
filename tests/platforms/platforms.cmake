# Other standard libraries, processors and systems: three examples, compiled for each and run where it can be run here.
set(platform_examples stack soft_beam crane)

# delassus_platform(<name> COMPILER <program> DEBIAN <package> [FLAGS <flag>...] [RUN <program>] [ENDING <.js>] [COMPILE_ONLY])
function(delassus_platform name)
  cmake_parse_arguments(platform "COMPILE_ONLY" "DEBIAN;RUN;ENDING" "COMPILER;FLAGS" ${ARGN})
  find_program(DELASSUS_${name}_COMPILER NAMES ${platform_COMPILER})
  mark_as_advanced(DELASSUS_${name}_COMPILER)
  set(runner "")
  if(platform_RUN)
    find_program(DELASSUS_${name}_RUN NAMES ${platform_RUN})
    mark_as_advanced(DELASSUS_${name}_RUN)
    set(runner ${DELASSUS_${name}_RUN})
  endif()
  if(NOT DELASSUS_${name}_COMPILER OR (platform_RUN AND NOT runner))
    message(STATUS "platform/${name} is left out: ${platform_COMPILER} ${platform_RUN} not found (apt-get install ${platform_DEBIAN})")
    return()
  endif()
  foreach(example IN LISTS platform_examples)
    add_test(NAME platform/${name}/${example} COMMAND ${CMAKE_COMMAND} -DCOMPILER=${DELASSUS_${name}_COMPILER}
      "-DFLAGS=${platform_FLAGS}" -DSOURCE=${PROJECT_SOURCE_DIR}/examples/${example}.cpp -DINCLUDE=${PROJECT_SOURCE_DIR}/include
      "-DSYSTEM=$<TARGET_PROPERTY:Eigen3::Eigen,INTERFACE_INCLUDE_DIRECTORIES>"
      -DPROGRAM=${CMAKE_CURRENT_BINARY_DIR}/platforms/${name}_${example}${platform_ENDING} -DRUN=${runner}
      -DCOMPILE_ONLY=${platform_COMPILE_ONLY} -P ${CMAKE_CURRENT_SOURCE_DIR}/platforms/compile_and_run.cmake)
    set_tests_properties(platform/${name}/${example} PROPERTIES TIMEOUT 600 LABELS platform)
  endforeach()
endfunction()

delassus_platform(libcxx COMPILER clang++ FLAGS -stdlib=libc++ DEBIAN "clang libc++-dev libc++abi-dev")
delassus_platform(aarch64 COMPILER aarch64-linux-gnu-g++ FLAGS -static RUN qemu-aarch64 DEBIAN "g++-aarch64-linux-gnu qemu-user")
delassus_platform(emscripten COMPILER em++ FLAGS -fexceptions -sSINGLE_FILE=1 RUN node ENDING .js DEBIAN "emscripten nodejs")
delassus_platform(mingw COMPILER x86_64-w64-mingw32-g++-posix x86_64-w64-mingw32-g++ ENDING .exe COMPILE_ONLY
  DEBIAN g++-mingw-w64-x86-64-posix)
