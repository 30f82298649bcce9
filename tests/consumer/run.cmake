# cmake -D BUILD_DIR=build/release -D WORK_DIR=... -P run.cmake
# Installs BUILD_DIR into a new folder and moves that folder, then builds and runs the consumer
# project against it.
cmake_minimum_required(VERSION 3.23)

function(run)
  execute_process(COMMAND ${ARGV} COMMAND_ECHO STDOUT COMMAND_ERROR_IS_FATAL ANY)
endfunction()

file(REMOVE_RECURSE ${WORK_DIR})
set(prefix ${WORK_DIR}/prefix)
run(${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${WORK_DIR}/elsewhere)
file(STRINGS ${BUILD_DIR}/install_manifest.txt installed)
list(FILTER installed EXCLUDE REGEX "^${WORK_DIR}/elsewhere/(bin|include|lib|libexec|share)/")
if(installed)
  message(FATAL_ERROR "installed at an unexpected place: ${installed}")
endif()
file(RENAME ${WORK_DIR}/elsewhere ${prefix})
cmake_path(SET source_headers NORMALIZE ${CMAKE_CURRENT_LIST_DIR}/../../include)
file(GLOB_RECURSE expected RELATIVE ${source_headers} ${source_headers}/*.h)
file(GLOB_RECURSE headers RELATIVE ${prefix}/include ${prefix}/include/*.h)
if(NOT headers STREQUAL expected)
  list(REMOVE_ITEM expected ${headers})
  message(FATAL_ERROR "public headers are not installed: ${expected}")
endif()
run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR} -B ${WORK_DIR}/build -G Ninja
    -D CMAKE_BUILD_TYPE=Release -D CMAKE_PREFIX_PATH=${prefix})
run(${CMAKE_COMMAND} --build ${WORK_DIR}/build)
run(${WORK_DIR}/build/consumer)
# Types of Eigen are the same for a program that is compiled for this processor.
run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR} -B ${WORK_DIR}/native -G Ninja
    -D CMAKE_BUILD_TYPE=Release -D CMAKE_PREFIX_PATH=${prefix} -D CMAKE_CXX_FLAGS=-march=native)
run(${CMAKE_COMMAND} --build ${WORK_DIR}/native)
run(${WORK_DIR}/native/consumer)

# The installed programs find the presets of the moved folder.
file(COPY_FILE ${prefix}/share/hullslam/config/presets/paper.yaml
               ${prefix}/share/hullslam/config/presets/moved.yaml)
execute_process(COMMAND ${prefix}/bin/hullslam-rgbd_tum --help OUTPUT_VARIABLE help
                COMMAND_ERROR_IS_FATAL ANY)
if(NOT help MATCHES "moved")
  message(FATAL_ERROR "the presets in ${prefix} are not found")
endif()

# The installed programs work from the moved folder, and their names do not collide with those of
# other programs.
file(GLOB programs RELATIVE ${prefix}/bin ${prefix}/bin/*)
foreach(name IN LISTS programs)
  if(NOT name MATCHES "^hullslam(-|$)")
    message(FATAL_ERROR "bin/${name} is installed, which may be the name of another program")
  endif()
  run(${prefix}/bin/${name} --help OUTPUT_QUIET)
endforeach()
foreach(name rgbd_tum make_synthetic plot_run reproduce_tables)
  if(NOT "hullslam-${name}" IN_LIST programs)
    message(FATAL_ERROR "bin/hullslam-${name} is missing")
  endif()
endforeach()

# A tool is a command of hullslam. The renderer is a program of its own, which hullslam finds beside
# itself.
foreach(command map-objects export evaluate check-masks train-vocabulary convert-vocabulary relocalise view)
  execute_process(COMMAND ${prefix}/bin/hullslam ${command} --help OUTPUT_VARIABLE help COMMAND_ERROR_IS_FATAL ANY)
  if(NOT help MATCHES "Usage: hullslam ${command} ")
    message(FATAL_ERROR "hullslam ${command} calls itself otherwise: ${help}")
  endif()
endforeach()
run(${prefix}/bin/hullslam make-synthetic --help OUTPUT_QUIET)
