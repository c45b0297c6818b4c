# How the programs of this repository are built: tests, examples, benchmarks, the demonstration. Nothing here is installed.

option(DELASSUS_WARNINGS_AS_ERRORS "Stop at a warning in the tests, examples and benchmarks" OFF)

if(PROJECT_IS_TOP_LEVEL)
  find_program(DELASSUS_CCACHE ccache)
  mark_as_advanced(DELASSUS_CCACHE)
  if(DELASSUS_CCACHE AND NOT DEFINED CMAKE_CXX_COMPILER_LAUNCHER)
    set(CMAKE_CXX_COMPILER_LAUNCHER ${DELASSUS_CCACHE})
  endif()
endif()
# The system's Python, for which apt installs NumPy and VTK, before others that stand on the path.
if(PROJECT_IS_TOP_LEVEL AND NOT DEFINED Python3_EXECUTABLE AND NOT DEFINED Python3_ROOT_DIR AND NOT DEFINED ENV{VIRTUAL_ENV})
  set(Python3_ROOT_DIR /usr)
endif()
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ${PROJECT_IS_TOP_LEVEL})

add_library(delassus_warnings INTERFACE)
target_compile_options(delassus_warnings INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Woverloaded-virtual
  -Wno-missing-field-initializers  # policies are set by designated initialisers: leaving a member out is the normal use
  $<$<CXX_COMPILER_ID:Clang,AppleClang>:-Wshadow-uncaptured-local>  # what g++ counts among -Wshadow
  # Flow analysis of inlined Eigen expressions; sanitizers look at the same mistakes without guessing.
  $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized;-Wno-array-bounds;-Wno-stringop-overflow>
  # No warning: g++ collects its garbage from 0.8 GB on, not from 0.1 GB. A sixth to a quarter of the compiler's time was that.
  $<$<CXX_COMPILER_ID:GNU>:--param=ggc-min-expand=100;--param=ggc-min-heapsize=800000>
  $<$<BOOL:${DELASSUS_WARNINGS_AS_ERRORS}>:-Werror>)

# What the tests share is compiled once, optimized whatever the tests are, and its headers are read once. Not for the benchmarks and the
# demonstration, which must compile with what they include themselves; an example includes the umbrella, and nothing comes to it unasked.
option(DELASSUS_COMPILE_ONCE "Compile once what the tests share, with headers precompiled" OFF)
if(DELASSUS_COMPILE_ONCE)
  target_link_libraries(delassus_compiled PRIVATE delassus_warnings)
  target_compile_options(delassus_compiled PRIVATE -O2)
  target_compile_definitions(delassus_compiled PUBLIC EIGEN_RUNTIME_NO_MALLOC)  # of the tests that count allocations
  set_target_properties(delassus_compiled PROPERTIES CXX_EXTENSIONS ${CMAKE_CXX_EXTENSIONS})  # it is older than the variable
endif()

# delassus_read_once(<name> <option> <header>...): compiles the headers for programs with these options.
function(delassus_read_once name option)
  file(CONFIGURE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/${name}.cpp CONTENT "")
  add_library(${name} STATIC ${CMAKE_CURRENT_BINARY_DIR}/${name}.cpp)
  target_link_libraries(${name} PRIVATE delassus::compiled delassus_warnings)
  target_compile_options(${name} PRIVATE ${option})
  target_precompile_headers(${name} PRIVATE ${ARGN})
endfunction()

# delassus_compile_once(<target> [<what delassus_read_once made>]): its sources see delassus/compiled.hpp first, and it links what that leaves out.
function(delassus_compile_once target)
  if(DELASSUS_COMPILE_ONCE AND TARGET ${target})
    set(headers ${ARGN})
    if(NOT headers)
      set(headers delassus_read)
      if(NOT TARGET ${headers})
        delassus_read_once(${headers} "" <delassus/compiled.hpp>)
      endif()
    endif()
    target_link_libraries(${target} PRIVATE delassus::compiled)
    target_precompile_headers(${target} REUSE_FROM ${headers})
  endif()
endfunction()

# delassus_components_of(<variable> <source>...): the components whose adapters the sources include.
# Editing such an include asks for a new configure.
function(delassus_components_of variable)
  set(found "")
  foreach(source IN LISTS ARGN)
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${source})
    file(STRINGS ${source} includes REGEX "^#include <delassus/adapters/")
    foreach(name IN LISTS DELASSUS_COMPONENTS)
      if(includes MATCHES "<delassus/adapters/${name}")
        list(APPEND found ${name})
      endif()
    endforeach()
  endforeach()
  list(REMOVE_DUPLICATES found)
  set(${variable} "${found}" PARENT_SCOPE)
endfunction()

# delassus_program(<name> <source>...): an executable with our warnings and the components its sources include.
# Without one of them there is a line that says so, and no target.
function(delassus_program name)
  delassus_components_of(components ${ARGN})
  foreach(component IN LISTS components)
    if(NOT TARGET delassus::${component})
      message(STATUS "${name} is left out: it needs the component ${component} (apt-get install ${DELASSUS_${component}_DEBIAN})")
      return()
    endif()
  endforeach()
  add_executable(${name} ${ARGN})
  list(TRANSFORM components PREPEND delassus::)
  target_link_libraries(${name} PRIVATE delassus::delassus ${components} delassus_warnings)
endfunction()

# delassus_program_threads(<name>): the program may include program_threads.hpp, which has threads where oneTBB is there.
function(delassus_program_threads name)
  if(TARGET delassus::tbb)
    target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR}/tools/with_tbb)
    target_link_libraries(${name} PRIVATE delassus::tbb)
  else()
    target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR}/tools/without_tbb)
  endif()
endfunction()
