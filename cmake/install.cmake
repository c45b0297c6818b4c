# The installed package: headers, one export per component, a config that explains itself, and a pkg-config file.
include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_DATADIR}/cmake/delassus)

install(TARGETS delassus EXPORT delassus-core FILE_SET HEADERS)
install(EXPORT delassus-core NAMESPACE delassus:: DESTINATION ${package_dir})

# What the config must know of each component, as lines of CMake.
set(component_table "set(delassus_known_components ${DELASSUS_COMPONENTS} compiled)\n")
foreach(name IN LISTS DELASSUS_COMPONENTS)
  foreach(fact PACKAGE VERSION FIND)
    string(APPEND component_table "set(delassus_${name}_${fact} ${DELASSUS_${name}_${fact}})\n")
  endforeach()
  string(APPEND component_table "set(delassus_${name}_DEBIAN \"${DELASSUS_${name}_DEBIAN}\")\n")
  if(TARGET delassus_${name})
    install(TARGETS delassus_${name} EXPORT delassus-${name} FILE_SET HEADERS)
    install(EXPORT delassus-${name} NAMESPACE delassus:: DESTINATION ${package_dir})
  endif()
endforeach()
string(REPLACE ";" " " component_table "${component_table}")

configure_package_config_file(cmake/delassus-config.cmake.in ${PROJECT_BINARY_DIR}/delassus-config.cmake
  INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/delassus-config-version.cmake
  COMPATIBILITY SameMinorVersion ARCH_INDEPENDENT)
install(FILES ${PROJECT_BINARY_DIR}/delassus-config.cmake ${PROJECT_BINARY_DIR}/delassus-config-version.cmake
  DESTINATION ${package_dir})
foreach(file FindCHOLMOD.cmake FindURDFDOM.cmake delassus-compiled.cmake delassus-compiled.cpp)
  install(FILES ${CMAKE_CURRENT_LIST_DIR}/${file} DESTINATION ${package_dir})
endforeach()

# Relative to the .pc file itself, so that a moved prefix still works.
file(RELATIVE_PATH include_from_pc ${CMAKE_INSTALL_FULL_DATADIR}/pkgconfig ${CMAKE_INSTALL_FULL_INCLUDEDIR})
configure_file(cmake/delassus.pc.in ${PROJECT_BINARY_DIR}/delassus.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/delassus.pc DESTINATION ${CMAKE_INSTALL_DATADIR}/pkgconfig)
