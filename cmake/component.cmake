# delassus_component(<name> PACKAGE <cmake package> [VERSION <v>] TARGET <its target> DEBIAN <apt packages> [FIND <how>...])
#
# <how> goes to find_package: CONFIG, or MODULE and what else CMake's own module wants.
# A component is the adapter headers of one third party, include/delassus/adapters/<name>*.hpp
# and those in the folder <name>, and a link to it.
# DELASSUS_WITH_<NAME> says what this build does: AUTO takes the package if it is found, ON insists, OFF drops the
# component. Whether the package is found here decides nothing about installing: headers do not depend on the builder's
# machine, so the installed package asks for the third party on the consumer's.

set(DELASSUS_COMPONENTS "")

macro(delassus_component name)
  cmake_parse_arguments(component "" "PACKAGE;VERSION;TARGET;DEBIAN" "FIND" ${ARGN})
  if(NOT component_FIND)
    set(component_FIND CONFIG)
  endif()
  string(TOUPPER ${name} NAME)
  set(DELASSUS_WITH_${NAME} AUTO CACHE STRING "The component ${name}: AUTO, ON or OFF")
  set_property(CACHE DELASSUS_WITH_${NAME} PROPERTY STRINGS AUTO ON OFF)
  set(DELASSUS_${name}_PACKAGE ${component_PACKAGE})
  set(DELASSUS_${name}_VERSION ${component_VERSION})
  set(DELASSUS_${name}_DEBIAN ${component_DEBIAN})
  set(DELASSUS_${name}_TARGET ${component_TARGET})
  set(DELASSUS_${name}_FIND ${component_FIND})
  list(APPEND DELASSUS_COMPONENTS ${name})

  if(DELASSUS_WITH_${NAME})
    string(STRIP "${component_PACKAGE} ${component_VERSION}" wanted)
    set(missing "delassus: component '${name}' needs ${wanted}; on Debian: apt-get install ${component_DEBIAN}")
    find_package(${component_PACKAGE} ${component_VERSION} QUIET ${component_FIND})
    if(NOT ${component_PACKAGE}_FOUND)
      if(DELASSUS_WITH_${NAME} STREQUAL "AUTO")
        message(STATUS "${missing}")
      else()
        message(FATAL_ERROR "${missing}")
      endif()
    endif()

    add_library(delassus_${name} INTERFACE)
    set_target_properties(delassus_${name} PROPERTIES EXPORT_NAME ${name})
    target_link_libraries(delassus_${name} INTERFACE delassus ${component_TARGET})
    file(GLOB adapter_headers CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/include/delassus/adapters/${name}*.hpp
      ${PROJECT_SOURCE_DIR}/include/delassus/adapters/${name}/*.hpp)
    target_sources(delassus_${name} INTERFACE FILE_SET HEADERS BASE_DIRS include FILES ${adapter_headers})
    if(${component_PACKAGE}_FOUND)
      add_library(delassus::${name} ALIAS delassus_${name})
    endif()
  endif()
endmacro()
