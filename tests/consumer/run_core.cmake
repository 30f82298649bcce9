# cmake -D BUILD_DIR=build/release -D WORK_DIR=... -P run_core.cmake
# Installs hullslam::core alone into a new folder, builds and runs the consumer project against it, and
# looks at what its program loads. The packages that only other components need are hidden from it.
cmake_minimum_required(VERSION 3.23)

function(run)
  execute_process(COMMAND ${ARGV} COMMAND_ECHO STDOUT COMMAND_ERROR_IS_FATAL ANY)
endfunction()

file(REMOVE_RECURSE ${WORK_DIR})
foreach(component core core_dev)
  run(${CMAKE_COMMAND} --install ${BUILD_DIR} --component ${component} --prefix ${WORK_DIR}/prefix)
endforeach()
set(hidden "")
foreach(package BZip2 JPEG PNG SQLite3 ZLIB nlohmann_json yaml-cpp)
  list(APPEND hidden -D CMAKE_DISABLE_FIND_PACKAGE_${package}=ON)
endforeach()
run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR} -B ${WORK_DIR}/build -G Ninja -D CORE_ONLY=ON
    -D CMAKE_BUILD_TYPE=Release -D CMAKE_PREFIX_PATH=${WORK_DIR}/prefix ${hidden})
run(${CMAKE_COMMAND} --build ${WORK_DIR}/build)
run(${WORK_DIR}/build/consumer)
# The same program for processors with AVX2, if this one has it, as when another package forces it.
file(STRINGS /proc/cpuinfo has_avx2 REGEX "^flags.* avx2( |$)" LIMIT_COUNT 1)
if(has_avx2)
  run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR} -B ${WORK_DIR}/avx2 -G Ninja -D CORE_ONLY=ON
      -D CMAKE_BUILD_TYPE=Release -D CMAKE_PREFIX_PATH=${WORK_DIR}/prefix -D CMAKE_CXX_FLAGS=-mavx2 ${hidden})
  run(${CMAKE_COMMAND} --build ${WORK_DIR}/avx2)
  run(${WORK_DIR}/avx2/consumer)
  # A program that is built by hand is stopped by the compiler instead.
  file(WRITE ${WORK_DIR}/by_hand.cc "#include <hullslam/system/system.h>\nint main() {}\n")
  execute_process(COMMAND c++ -std=c++20 -mavx2 -fsyntax-only -I${WORK_DIR}/prefix/include -isystem /usr/include/eigen3
                  -isystem /usr/include/opencv4 ${WORK_DIR}/by_hand.cc RESULT_VARIABLE code ERROR_VARIABLE message)
  if(code EQUAL 0 OR NOT message MATCHES "EIGEN_MAX_ALIGN_BYTES=16")
    message(FATAL_ERROR "a program with other types of Eigen is compiled: ${message}")
  endif()
endif()

execute_process(COMMAND ldd ${WORK_DIR}/build/consumer OUTPUT_VARIABLE loaded
                COMMAND_ERROR_IS_FATAL ANY)
foreach(library avformat bz2 jpeg lz4 opencv_dnn opencv_videoio png sqlite yaml-cpp zstd)
  if(loaded MATCHES "lib${library}")
    message(FATAL_ERROR "a program that uses hullslam::core loads ${library}: ${loaded}")
  endif()
endforeach()
# Boost.Beast has headers only, so its names would be in the program.
file(STRINGS ${WORK_DIR}/build/consumer beast REGEX "boost.*beast")
if(beast)
  message(FATAL_ERROR "a program that uses hullslam::core has Boost.Beast in it: ${beast}")
endif()

# A component that is not there is an error with its reason.
foreach(component io nonsense)
  file(WRITE ${WORK_DIR}/${component}/CMakeLists.txt "cmake_minimum_required(VERSION 3.23)\nproject(user LANGUAGES CXX)\n"
       "find_package(hullslam REQUIRED COMPONENTS ${component})\n")
  execute_process(COMMAND ${CMAKE_COMMAND} -S ${WORK_DIR}/${component} -B ${WORK_DIR}/${component}/build -G Ninja
                  -D CMAKE_PREFIX_PATH=${WORK_DIR}/prefix RESULT_VARIABLE code ERROR_VARIABLE message OUTPUT_QUIET)
  string(REGEX REPLACE "[ \n]+" " " message "${message}")
  if(code EQUAL 0 OR NOT message MATCHES "no component ${component}, (because it was built with HULLSLAM_CORE_ONLY|expected core)")
    message(FATAL_ERROR "find_package with component ${component} ended with ${code}: ${message}")
  endif()
endforeach()
