# All libraries are Debian 12 packages (Thirdparty/apt-packages.txt). Their versions are checked
# here, so that an unsupported system gives an error when CMake configures and not during the build.
find_package(Threads REQUIRED)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(OpenCV 4.6 REQUIRED COMPONENTS core imgproc features2d calib3d)
find_package(Ceres 2.1 REQUIRED)
find_package(CGAL 5.5 REQUIRED)  # headers only: convex hulls, oriented boxes; needs GMP and MPFR
find_package(fmt 9 REQUIRED)
find_package(spdlog 1.10 REQUIRED)
find_package(Boost 1.74 REQUIRED)  # headers only: CRC, matching, Student's t-distribution, Beast
find_path(XXHASH_INCLUDE_DIR xxhash.h REQUIRED)  # only the header of libxxhash-dev 0.8 is used
if(HULLSLAM_CORE_ONLY)
  return()
endif()
find_package(PNG 1.6 REQUIRED)
find_package(JPEG 62 REQUIRED)  # libjpeg-turbo 2.1, which has the interface of libjpeg 6b
find_package(nlohmann_json 3.11 REQUIRED)
find_package(yaml-cpp 0.7 REQUIRED)  # settings and calibrations
find_package(ZLIB 1.2 REQUIRED)  # checksum of map files
if(HULLSLAM_WITH_BAGS)
  find_package(BZip2 1.0 REQUIRED)
  find_package(SQLite3 3.40 REQUIRED)
  find_path(LZ4_INCLUDE_DIR lz4frame.h REQUIRED)  # liblz4-dev 1.9; has no package for CMake
  find_path(ZSTD_INCLUDE_DIR zstd.h REQUIRED)     # libzstd-dev 1.5
endif()
if(HULLSLAM_WITH_VIDEO)
  find_path(AVFORMAT_INCLUDE_DIR libavformat/avformat.h REQUIRED)  # FFmpeg 5.1
  find_path(AVCODEC_INCLUDE_DIR libavcodec/avcodec.h REQUIRED)
  find_path(SWSCALE_INCLUDE_DIR libswscale/swscale.h REQUIRED)
endif()
if(HULLSLAM_WITH_SEGMENTATION)
  find_package(OpenCV 4.6 REQUIRED COMPONENTS core imgproc features2d calib3d dnn)
endif()
if(HULLSLAM_WITH_LIVE)
  # three.js, for the page: libjs-three (111)
  find_path(HULLSLAM_THREE_DIR examples/js/controls/OrbitControls.js PATHS /usr/share/javascript/three
            NO_DEFAULT_PATH REQUIRED)
endif()
if(HULLSLAM_BUILD_EXAMPLES OR HULLSLAM_BUILD_TESTS)
  find_package(CLI11 2.1 REQUIRED)
  find_package(embree 3.13 REQUIRED)
endif()
if(HULLSLAM_BUILD_TESTS)
  find_package(GTest 1.12 REQUIRED)
  find_package(OpenCV 4.6 REQUIRED COMPONENTS core imgproc imgcodecs videoio features2d calib3d)
endif()
if(HULLSLAM_BUILD_PYTHON)
  # Another Python that comes first on the PATH, such as that of pyenv, may lack numpy.
  if(NOT Python_EXECUTABLE)
    find_program(Python_EXECUTABLE python3 PATHS /usr/bin NO_DEFAULT_PATH)
  endif()
  find_package(Python 3.11 REQUIRED COMPONENTS Interpreter Development.Module NumPy)
  find_package(pybind11 2.10 REQUIRED)
endif()
if(HULLSLAM_BUILD_BENCH)
  find_package(benchmark 1.7 REQUIRED)
endif()
