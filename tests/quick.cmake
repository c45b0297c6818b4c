# Every test source as a program of its own, one_<room>_<name>, and the traces. Nothing is built that is not named: scripts/quick.py and
# scripts/tests_of.py name it.
file(GLOB_RECURSE sources CONFIGURE_DEPENDS *.cpp)
foreach(source IN LISTS sources)
  cmake_path(RELATIVE_PATH source BASE_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR} OUTPUT_VARIABLE place)
  if(place MATCHES "^(compile_fail|fuzz|mutants|odr|package|static|thread_sanitizer|trace|zero_cost)/")
    continue()
  endif()
  cmake_path(REMOVE_EXTENSION place)
  string(REPLACE "/" "_" name "one_${place}")
  delassus_program(${name} ${source})
  if(TARGET ${name})
    target_include_directories(${name} PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})
    target_link_libraries(${name} PRIVATE Catch2::Catch2WithMain)
    set_target_properties(${name} PROPERTIES EXCLUDE_FROM_ALL ON)
  endif()
endforeach()

delassus_traces()

# What scripts/quick.py counts instructions of: built as users build, with assertions off.
file(GLOB sources CONFIGURE_DEPENDS zero_cost/counted_*.cpp)
foreach(source IN LISTS sources)
  cmake_path(GET source STEM name)
  delassus_program(${name} ${source})
  target_compile_options(${name} PRIVATE -O2 -DNDEBUG)
  set_target_properties(${name} PROPERTIES EXCLUDE_FROM_ALL ON)
endforeach()
