# urdfdom, which reads URDF, and tinyxml2, which says on which line things stand: defines URDFDOM::URDFDOM.
find_package(urdfdom CONFIG QUIET)
find_package(tinyxml2 CONFIG QUIET)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(URDFDOM REQUIRED_VARS urdfdom_FOUND tinyxml2_FOUND)
if(URDFDOM_FOUND AND NOT TARGET URDFDOM::URDFDOM)
  add_library(URDFDOM::URDFDOM INTERFACE IMPORTED)
  target_link_libraries(URDFDOM::URDFDOM INTERFACE urdfdom::urdfdom_model tinyxml2::tinyxml2)
endif()
