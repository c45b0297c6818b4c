# Checks that compile little and run no physics: they look at the tree as a newcomer, a packager or a compiler meets it.
find_package(Python3 COMPONENTS Interpreter QUIET)
if(NOT Python3_FOUND)
  message(FATAL_ERROR "The checks of the tree need Python 3 (apt-get install python3), or -DDELASSUS_TEST_TREE=OFF")
endif()
find_program(DELASSUS_CLANG NAMES clang++ clang++-19 clang++-16 clang++-14)
mark_as_advanced(DELASSUS_CLANG)

# The compilers the scripts use: the one of this build, and in ./run test --all the other of g++ and clang++ too.
find_program(DELASSUS_GXX g++)
mark_as_advanced(DELASSUS_GXX)
set(compilers ${CMAKE_CXX_COMPILER})
set(compiler_names ${CMAKE_CXX_COMPILER_ID})
if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
  set(other ${DELASSUS_GXX})
  set(other_name GNU)
else()
  set(other ${DELASSUS_CLANG})
  set(other_name Clang)
endif()
if(other AND DELASSUS_TEST_ALL)
  list(APPEND compilers ${other})
  list(APPEND compiler_names ${other_name})
endif()

# The system include directories of Eigen and of the components that are here, without /usr/include: named by -isystem it
# hides the C library from the C++ one.
set(include_dirs $<TARGET_PROPERTY:Eigen3::Eigen,INTERFACE_INCLUDE_DIRECTORIES>)
set(absent "")
foreach(component IN LISTS DELASSUS_COMPONENTS)
  if(NOT TARGET delassus::${component})
    list(APPEND absent ${component})
  else()
    list(APPEND include_dirs
      $<FILTER:$<TARGET_PROPERTY:${DELASSUS_${component}_TARGET},INTERFACE_INCLUDE_DIRECTORIES>,EXCLUDE,^/usr/include/?$>)
  endif()
endforeach()

function(delassus_tree_test name)
  add_test(NAME ${name} COMMAND ${ARGN} COMMAND_EXPAND_LISTS)
  # COST: the long ones first, so that none of them runs on alone at the end.
  set_tests_properties(${name} PROPERTIES TIMEOUT 1500 LABELS tree COST 100)
endfunction()

# --- rooms and levels -----------------------------------------------------------------------------------------------
set(scripts ${PROJECT_SOURCE_DIR}/scripts)
delassus_tree_test(tree/includes ${Python3_EXECUTABLE} ${scripts}/check_includes.py ${PROJECT_SOURCE_DIR})
delassus_tree_test(tree/includes_self_test ${Python3_EXECUTABLE} ${scripts}/check_includes.py --self-test)

# --- the pages: programs shown are the examples, links lead somewhere -----------------------------------------------
delassus_tree_test(tree/docs ${Python3_EXECUTABLE} ${scripts}/check_docs.py ${PROJECT_SOURCE_DIR})
delassus_tree_test(tree/docs_self_test ${Python3_EXECUTABLE} ${scripts}/check_docs.py --self-test)
delassus_tree_test(tree/words ${Python3_EXECUTABLE} ${scripts}/check_words.py ${PROJECT_SOURCE_DIR})
delassus_tree_test(tree/words_self_test ${Python3_EXECUTABLE} ${scripts}/check_words.py --self-test)
find_program(DELASSUS_DOXYGEN doxygen)
mark_as_advanced(DELASSUS_DOXYGEN)
if(DELASSUS_TEST_ALL OR DELASSUS_DOXYGEN)
  delassus_tree_test(tree/site ${Python3_EXECUTABLE} ${scripts}/build_site.py --out ${PROJECT_BINARY_DIR}/site)
endif()

delassus_tree_test(tree/siconos_page_self_test ${Python3_EXECUTABLE} ${scripts}/siconos_page.py --self-test)
delassus_tree_test(tree/front_page ${Python3_EXECUTABLE} ${scripts}/front_page.py --check)

# --- the mutants of scripts/mutants.py still find what they replace --------------------------------------------------
delassus_tree_test(tree/mutants ${Python3_EXECUTABLE} ${scripts}/mutants.py --check)

# --- every header by itself, in ./run test those that pages and examples show ----------------------------------------
set(which "")
if(NOT DELASSUS_TEST_ALL)
  set(which --shown)
endif()
delassus_tree_test(tree/headers_alone ${Python3_EXECUTABLE} ${scripts}/check_headers.py ${PROJECT_SOURCE_DIR} ${which}
  --cache ${PROJECT_BINARY_DIR}/headers_alone --compiler ${compilers} --system ${include_dirs} --absent ${absent})
delassus_tree_test(tree/headers_alone_self_test ${Python3_EXECUTABLE} ${scripts}/check_headers.py --self-test
  --compiler ${compilers})
# A minute or more the first time; a header that did not change is not compiled again.
set_tests_properties(tree/headers_alone PROPERTIES PROCESSORS 2 TIMEOUT 1500)

# --- what programs cost to compile: budgets and counts are g++'s ------------------------------------------------------
if(DELASSUS_GXX)
  set(which "")
  if(NOT DELASSUS_TEST_ALL)
    set(which delassus.hpp falling_box stack)
  endif()
  delassus_tree_test(tree/compile_budget ${Python3_EXECUTABLE} ${scripts}/compile_budget.py ${PROJECT_SOURCE_DIR}
    --check ${which} --compiler ${DELASSUS_GXX} --system ${include_dirs} --absent ${absent})
endif()

# --- what is absent costs nothing; what a step costs against one written by hand --------------------------------------
if(DELASSUS_TEST_ALL AND DELASSUS_GXX)
  set(zero_cost ${CMAKE_CURRENT_SOURCE_DIR}/zero_cost)
  foreach(name compiled_to frames step_cost sleep_cost)
    delassus_tree_test(zero_cost/${name} ${Python3_EXECUTABLE} ${zero_cost}/${name}.py ${PROJECT_SOURCE_DIR}
      --compiler ${DELASSUS_GXX} --system ${include_dirs})
  endforeach()
  set_tests_properties(zero_cost/frames zero_cost/step_cost zero_cost/sleep_cost PROPERTIES SKIP_RETURN_CODE 77)
endif()

# --- wrong programs and the sentence each must print ----------------------------------------------------------------
# Nearly all of them start with the umbrella header, which takes most of their time: each compiler precompiles it first.
foreach(compiler compiler_name IN ZIP_LISTS compilers compiler_names)
  set(name "compile_fail/precompile (${compiler_name})")
  string(COMPARE EQUAL ${compiler_name} Clang is_clang)
  add_test(NAME ${name} COMMAND ${CMAKE_COMMAND} -DCOMPILER=${compiler} -DIS_CLANG=${is_clang}
    -DINCLUDE=${PROJECT_SOURCE_DIR}/include "-DSYSTEM=${include_dirs}"
    -DPRECOMPILED=${CMAKE_CURRENT_BINARY_DIR}/compile_fail/${compiler_name}
    -P ${PROJECT_SOURCE_DIR}/tests/compile_fail/precompile.cmake)
  set_tests_properties(${name} PROPERTIES TIMEOUT 120 LABELS compile_fail FIXTURES_SETUP precompiled_${compiler_name})
endforeach()

function(delassus_compile_fail name source)
  foreach(compiler compiler_name IN ZIP_LISTS compilers compiler_names)
    add_test(NAME "${name} (${compiler_name})" COMMAND ${CMAKE_COMMAND} -DSOURCE=${source} -DCOMPILER=${compiler}
      -DINCLUDE=${PROJECT_SOURCE_DIR}/include "-DSYSTEM=${include_dirs}"
      -DPRECOMPILED=${CMAKE_CURRENT_BINARY_DIR}/compile_fail/${compiler_name}
      -P ${PROJECT_SOURCE_DIR}/tests/compile_fail/expect_error.cmake)
    set_tests_properties("${name} (${compiler_name})" PROPERTIES TIMEOUT 120 LABELS compile_fail
      FIXTURES_REQUIRED precompiled_${compiler_name} ${ARGN})
  endforeach()
endfunction()

file(GLOB sources CONFIGURE_DEPENDS compile_fail/*.cpp)
foreach(source IN LISTS sources)
  cmake_path(GET source STEM name)
  delassus_compile_fail(compile_fail/${name} ${source})
endforeach()

# The driver itself must fail, and say why, on a program that compiles, errs twice, says another thing, expects nothing.
set(self_check ${CMAKE_CURRENT_SOURCE_DIR}/compile_fail/self_check)
delassus_compile_fail(compile_fail/self_check/one_sentence ${self_check}/one_sentence.cpp)
delassus_compile_fail(compile_fail/self_check/compiles ${self_check}/compiles.cpp
  PASS_REGULAR_EXPRESSION "it compiles")
delassus_compile_fail(compile_fail/self_check/two_errors ${self_check}/two_errors.cpp
  PASS_REGULAR_EXPRESSION "2 errors instead of one")
delassus_compile_fail(compile_fail/self_check/other_sentence ${self_check}/other_sentence.cpp
  PASS_REGULAR_EXPRESSION "the sentence is missing")
delassus_compile_fail(compile_fail/self_check/no_expectation ${self_check}/no_expectation.cpp
  PASS_REGULAR_EXPRESSION "its first line is not `// expect: ")

add_subdirectory(package)
