# The Debian packages; scripts/make_packages.sh makes them. Each is a component of the installation:
#
#   libhullslam-core0.1   core: the shared library hullslam::core
#   libhullslam-core-dev  core_dev: its headers, CMake package
#   libhullslam0.1        library: the other shared libraries, settings of known cameras, vocabulary
#   libhullslam-dev       dev: their headers, pkg-config
#   hullslam              tools: programs, scripts, manual pages
#   python3-hullslam      python: the Python module
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME hullslam)
set(CPACK_PACKAGE_VENDOR HullSLAM)
set(CPACK_PACKAGE_CONTACT "the HullSLAM developers <hullslam@example.org>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY ${PROJECT_DESCRIPTION})
set(CPACK_PACKAGING_INSTALL_PREFIX ${CMAKE_INSTALL_PREFIX})
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL core core_dev library dev tools python)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${PROJECT_BINARY_DIR}/src)

set(soname ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
set(same "(= ${PROJECT_VERSION})")
set(CPACK_DEBIAN_CORE_PACKAGE_NAME libhullslam-core${soname})
set(CPACK_DEBIAN_CORE_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_CORE_DEV_PACKAGE_NAME libhullslam-core-dev)
set(CPACK_DEBIAN_CORE_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_CORE_DEV_PACKAGE_DEPENDS
    "libhullslam-core${soname} ${same}, libeigen3-dev, libopencv-dev")
set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME libhullslam${soname})
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_DEPENDS "libhullslam-core${soname} ${same}")
# The library loads FFmpeg 5.1 when a video is opened, so dpkg-shlibdeps does not see it.
set(CPACK_DEBIAN_LIBRARY_PACKAGE_RECOMMENDS "libavformat59, libavcodec59, libavutil57, libswscale6")
set(CPACK_DEBIAN_DEV_PACKAGE_NAME libhullslam-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS "libhullslam${soname} ${same}, libhullslam-core-dev ${same}")
set(CPACK_DEBIAN_TOOLS_PACKAGE_NAME hullslam)
set(CPACK_DEBIAN_TOOLS_PACKAGE_SECTION science)
set(CPACK_DEBIAN_TOOLS_PACKAGE_DEPENDS
    "libhullslam${soname} ${same}, python3, python3-numpy, python3-matplotlib, python3-opencv, python3-yaml, python3-jsonschema")
set(CPACK_DEBIAN_TOOLS_PACKAGE_RECOMMENDS "snakemake, python3-onnx, python3-hullslam")
set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-hullslam)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
# A module is compiled for one minor version of Python.
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "libhullslam${soname} ${same}, python3 (>= 3.11), python3 (<< 3.12), python3-numpy")
foreach(component IN LISTS CPACK_COMPONENTS_ALL)
  string(TOUPPER ${component} upper)
  install(FILES packaging/copyright Thirdparty/NOTICE.md COMPONENT ${component}
          DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${CPACK_DEBIAN_${upper}_PACKAGE_NAME})
endforeach()
include(CPack)
