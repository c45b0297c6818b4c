# delassus::compiled: what delassus/compiled.hpp leaves out, as a library that is built where it is used, with the flags of who uses it.
# Read by this project and by the installed package.
if(NOT TARGET delassus::compiled)
  add_library(delassus_compiled STATIC EXCLUDE_FROM_ALL ${CMAKE_CURRENT_LIST_DIR}/delassus-compiled.cpp)
  target_link_libraries(delassus_compiled PUBLIC delassus::delassus)
  add_library(delassus::compiled ALIAS delassus_compiled)
endif()
