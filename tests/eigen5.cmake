# The examples and three rooms' tests against the headers of another Eigen, 5 for instance, in a build of their own.
set(DELASSUS_EIGEN_5 "" CACHE PATH "A folder with the headers of Eigen 5: ./run test --all then tests against them too")
if(NOT DELASSUS_EIGEN_5)
  message(STATUS "The tests against Eigen 5 are left out: DELASSUS_EIGEN_5 names no folder with its headers")
  return()
endif()

set(folder ${PROJECT_BINARY_DIR}/eigen5)
add_test(NAME eigen5/configure COMMAND ${CMAKE_COMMAND} -S ${PROJECT_SOURCE_DIR} -B ${folder} -G ${CMAKE_GENERATOR}
  -DCMAKE_CXX_COMPILER=clang++ -DCMAKE_BUILD_TYPE=Debug "-DCMAKE_CXX_FLAGS_DEBUG=-O1 -g0" -DDELASSUS_EIGEN_DIR=${DELASSUS_EIGEN_5}
  -DDELASSUS_COMPILE_ONCE=ON -DCMAKE_UNITY_BUILD=ON -DCMAKE_UNITY_BUILD_BATCH_SIZE=4 -DDELASSUS_TEST_TREE=OFF
  -DDELASSUS_BUILD_BENCHMARKS=OFF -DDELASSUS_BUILD_DEMONSTRATION=OFF -DDELASSUS_BUILD_STUDIES=OFF -DDELASSUS_BUILD_TOOLS=OFF)
# FCL is built against the Eigen of its package, so its example stays out.
file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/examples/*.cpp)
set(targets test_core test_solvers test_loop)
foreach(source IN LISTS sources)
  file(STRINGS ${source} adapters REGEX "^#include <delassus/adapters/")
  cmake_path(GET source STEM name)
  if(NOT adapters)
    list(APPEND targets example_${name})
  endif()
endforeach()
add_test(NAME eigen5/build COMMAND ${CMAKE_COMMAND} --build ${folder} --target ${targets})
add_test(NAME eigen5/run COMMAND ${CMAKE_CTEST_COMMAND} --test-dir ${folder} -R "^(core|solvers|loop)/|^example/" -E fcl --output-on-failure)
set_tests_properties(eigen5/configure PROPERTIES FIXTURES_SETUP eigen5_configured TIMEOUT 120)
set_tests_properties(eigen5/build PROPERTIES FIXTURES_REQUIRED eigen5_configured FIXTURES_SETUP eigen5_built TIMEOUT 3600 PROCESSORS 2)
set_tests_properties(eigen5/run PROPERTIES FIXTURES_REQUIRED eigen5_built TIMEOUT 1200 PROCESSORS 2)
