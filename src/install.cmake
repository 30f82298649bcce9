# Installs the public headers, the library, the settings of known cameras, and a CMake package for
# find_package(hullslam). Examples/CMakeLists.txt installs the programs.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(HULLSLAM_INSTALL_CONFIGDIR ${CMAKE_INSTALL_DATADIR}/hullslam/config)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/hullslam)

install(TARGETS hullslam EXPORT hullslamTargets)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/hullslam TYPE INCLUDE FILES_MATCHING PATTERN *.h)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/config/ DESTINATION ${HULLSLAM_INSTALL_CONFIGDIR})
install(EXPORT hullslamTargets NAMESPACE hullslam:: DESTINATION ${package_dir})

configure_package_config_file(
  ${CMAKE_CURRENT_SOURCE_DIR}/hullslamConfig.cmake.in ${CMAKE_CURRENT_BINARY_DIR}/hullslamConfig.cmake
  INSTALL_DESTINATION ${package_dir} PATH_VARS HULLSLAM_INSTALL_CONFIGDIR)
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/hullslamConfigVersion.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/hullslamConfig.cmake
              ${CMAKE_CURRENT_BINARY_DIR}/hullslamConfigVersion.cmake
        DESTINATION ${package_dir})
