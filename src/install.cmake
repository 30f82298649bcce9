# Installs the public headers, the library, the settings of known cameras, the default vocabulary,
# the scripts that make, draw and compare runs, and packages for find_package(hullslam) and
# pkg-config. Examples/CMakeLists.txt installs the programs. The components are those of
# packaging/cpack.cmake.
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
  install(FILES ${link} DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT tools)
endfunction()

# The public headers of these modules, as the component.
function(hullslam_install_headers component)
  foreach(module IN LISTS ARGN)
    if(EXISTS ${PROJECT_SOURCE_DIR}/include/hullslam/${module})
      install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/hullslam/${module} COMPONENT ${component}
              DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/hullslam FILES_MATCHING PATTERN *.h)
    endif()
  endforeach()
endfunction()

# hullslam_install_library(TARGET EXPORT COMPONENT DEV): the library, as COMPONENT, and what a user
# needs to build with it, as DEV.
function(hullslam_install_library target export component dev)
  install(TARGETS ${target} EXPORT ${export}
          LIBRARY COMPONENT ${component} NAMELINK_COMPONENT ${dev}
          ARCHIVE COMPONENT ${dev})
  install(EXPORT ${export} NAMESPACE hullslam:: DESTINATION ${package_dir} COMPONENT ${dev})
endfunction()

hullslam_install_library(hullslam_core hullslamCoreTargets core core_dev)
hullslam_install_headers(core_dev ${HULLSLAM_CORE_MODULES})
configure_package_config_file(
  ${CMAKE_CURRENT_SOURCE_DIR}/hullslamConfig.cmake.in ${CMAKE_CURRENT_BINARY_DIR}/hullslamConfig.cmake
  INSTALL_DESTINATION ${package_dir} PATH_VARS HULLSLAM_INSTALL_CONFIGDIR HULLSLAM_INSTALL_VOCABULARYDIR)
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/hullslamConfigVersion.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/hullslamConfig.cmake
              ${CMAKE_CURRENT_BINARY_DIR}/hullslamConfigVersion.cmake
        DESTINATION ${package_dir} COMPONENT core_dev)
if(HULLSLAM_CORE_ONLY)
  return()
endif()

hullslam_install_library(hullslam_io hullslamIoTargets library dev)
hullslam_install_library(hullslam hullslamTargets library dev)
hullslam_install_headers(dev ${HULLSLAM_IO_MODULES} ${HULLSLAM_OTHER_MODULES})
set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME dev)
# The library looks for the settings and the vocabulary itself.
install(DIRECTORY ${PROJECT_SOURCE_DIR}/config/ DESTINATION ${HULLSLAM_INSTALL_CONFIGDIR}
        COMPONENT library)
install(FILES ${PROJECT_SOURCE_DIR}/Vocabulary/hullslam.bow ${PROJECT_SOURCE_DIR}/Vocabulary/README.md
        DESTINATION ${HULLSLAM_INSTALL_VOCABULARYDIR} COMPONENT library)
file(GLOB scripts CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/scripts/plot_*.py
                                   ${PROJECT_SOURCE_DIR}/scripts/run_*.py
                                   ${PROJECT_SOURCE_DIR}/scripts/support.py)
# The script for the tables of the paper, what it starts, and what makes masks.
foreach(script reproduce_tables degrade_sequence disturbances leave_and_return tum_and_icl
               yolo_masks make_masks prepare_network vslamlab)
  list(APPEND scripts ${PROJECT_SOURCE_DIR}/scripts/${script}.py)
endforeach()
list(APPEND scripts ${PROJECT_SOURCE_DIR}/scripts/run_demo.sh ${PROJECT_SOURCE_DIR}/scripts/common.sh)
install(PROGRAMS ${scripts} DESTINATION ${CMAKE_INSTALL_DATADIR}/hullslam/scripts COMPONENT tools)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/scripts/paper_tables
        DESTINATION ${CMAKE_INSTALL_DATADIR}/hullslam/scripts COMPONENT tools
        PATTERN __pycache__ EXCLUDE)
hullslam_install_link(hullslam-demo ${CMAKE_INSTALL_DATADIR}/hullslam/scripts/run_demo.sh)
foreach(mode mono rgbd stereo)
  hullslam_install_link(hullslam-vslamlab_hullslam_${mode}
                        ${CMAKE_INSTALL_DATADIR}/hullslam/scripts/vslamlab.py)
endforeach()
foreach(script plot_run reproduce_tables make_masks prepare_network)
  hullslam_install_link(hullslam-${script} ${CMAKE_INSTALL_DATADIR}/hullslam/scripts/${script}.py)
endforeach()

# What a static library needs is only known to its CMake package.
if(BUILD_SHARED_LIBS)
  configure_file(${PROJECT_SOURCE_DIR}/packaging/hullslam.pc.in
                 ${CMAKE_CURRENT_BINARY_DIR}/hullslam.pc @ONLY)
  install(FILES ${CMAKE_CURRENT_BINARY_DIR}/hullslam.pc
          DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
endif()
