# Installs the public headers, the library, the settings of known cameras, the default vocabulary,
# the scripts that make, draw and compare runs, and a CMake package for find_package(hullslam). Examples/CMakeLists.txt installs the
# programs.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(HULLSLAM_INSTALL_CONFIGDIR ${CMAKE_INSTALL_DATADIR}/hullslam/config)
set(HULLSLAM_INSTALL_VOCABULARYDIR ${CMAKE_INSTALL_DATADIR}/hullslam/Vocabulary)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/hullslam)

# hullslam_install_link(NAME FILE): installs bin/NAME as a relative link to FILE of the installation.
function(hullslam_install_link name file)
  file(RELATIVE_PATH target /prefix/${CMAKE_INSTALL_BINDIR} /prefix/${file})
  set(link ${PROJECT_BINARY_DIR}/links/${name})
  file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/links)
  file(CREATE_LINK ${target} ${link} SYMBOLIC)
  install(FILES ${link} DESTINATION ${CMAKE_INSTALL_BINDIR})
endfunction()

install(TARGETS hullslam EXPORT hullslamTargets)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/hullslam TYPE INCLUDE FILES_MATCHING PATTERN *.h)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/config/ DESTINATION ${HULLSLAM_INSTALL_CONFIGDIR})
install(FILES ${PROJECT_SOURCE_DIR}/Vocabulary/hullslam.bow ${PROJECT_SOURCE_DIR}/Vocabulary/README.md
        DESTINATION ${HULLSLAM_INSTALL_VOCABULARYDIR})
file(GLOB scripts CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/scripts/plot_*.py
                                   ${PROJECT_SOURCE_DIR}/scripts/run_*.py
                                   ${PROJECT_SOURCE_DIR}/scripts/object_*.py
                                   ${PROJECT_SOURCE_DIR}/scripts/python_packages.py
                                   ${PROJECT_SOURCE_DIR}/scripts/ablation.py)
# The script for the tables of the paper, what it starts, and what makes masks.
foreach(script reproduce_tables table_job degrade_sequence disturbances leave_and_return tum_and_icl
               yolo_masks make_masks report)
  list(APPEND scripts ${PROJECT_SOURCE_DIR}/scripts/${script}.py)
endforeach()
install(PROGRAMS ${scripts} DESTINATION ${CMAKE_INSTALL_DATADIR}/hullslam/scripts)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/scripts/paper_tables
        DESTINATION ${CMAKE_INSTALL_DATADIR}/hullslam/scripts PATTERN __pycache__ EXCLUDE)
foreach(script plot_run ablation plot_ablation object_table reproduce_tables make_masks)
  hullslam_install_link(hullslam-${script} ${CMAKE_INSTALL_DATADIR}/hullslam/scripts/${script}.py)
endforeach()
install(EXPORT hullslamTargets NAMESPACE hullslam:: DESTINATION ${package_dir})

configure_package_config_file(
  ${CMAKE_CURRENT_SOURCE_DIR}/hullslamConfig.cmake.in ${CMAKE_CURRENT_BINARY_DIR}/hullslamConfig.cmake
  INSTALL_DESTINATION ${package_dir} PATH_VARS HULLSLAM_INSTALL_CONFIGDIR HULLSLAM_INSTALL_VOCABULARYDIR)
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/hullslamConfigVersion.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/hullslamConfig.cmake
              ${CMAKE_CURRENT_BINARY_DIR}/hullslamConfigVersion.cmake
        DESTINATION ${package_dir})
