# cmake -D SOURCE_DIR=. -D BUILD_DIR=build/release -D WORK_DIR=... -D FLAGS=... -D COMPONENTS=VIDEO;BAGS;... -P run.cmake
# Builds the core alone, without the packages that it does not need, then the programs without any
# component, and checks that these say so where one is asked for. The builds are beside BUILD_DIR,
# because ccache only knows objects again that were compiled in a folder of the same depth.
cmake_minimum_required(VERSION 3.23)

function(run)
  execute_process(COMMAND ${ARGV} COMMAND_ECHO STDOUT COMMAND_ERROR_IS_FATAL ANY)
endfunction()

function(configure folder)
  run(${CMAKE_COMMAND} -S ${SOURCE_DIR} -B ${folder} -G Ninja -D CMAKE_BUILD_TYPE=Release
      -D CMAKE_UNITY_BUILD=ON -D CMAKE_CXX_FLAGS=${FLAGS} ${ARGN})
endfunction()

file(REMOVE_RECURSE ${WORK_DIR} ${BUILD_DIR}-core ${BUILD_DIR}-none)
file(MAKE_DIRECTORY ${WORK_DIR})
set(hidden "")
foreach(package BZip2 JPEG PNG SQLite3 ZLIB nlohmann_json yaml-cpp)
  list(APPEND hidden -D CMAKE_DISABLE_FIND_PACKAGE_${package}=ON)
endforeach()
configure(${BUILD_DIR}-core -D HULLSLAM_CORE_ONLY=ON ${hidden})
run(${CMAKE_COMMAND} --build ${BUILD_DIR}-core)

set(off -D CMAKE_DISABLE_FIND_PACKAGE_BZip2=ON -D CMAKE_DISABLE_FIND_PACKAGE_SQLite3=ON)
foreach(component IN LISTS COMPONENTS)
  list(APPEND off -D HULLSLAM_WITH_${component}=OFF)
endforeach()
configure(${BUILD_DIR}-none ${off})
run(${CMAKE_COMMAND} --build ${BUILD_DIR}-none)

# expect_fault(COMPONENT command...): the command ends with exit code 2 and names the component.
function(expect_fault component program)
  execute_process(COMMAND ${BUILD_DIR}-none/bin/${program} ${ARGN} WORKING_DIRECTORY ${WORK_DIR}
                  RESULT_VARIABLE code ERROR_VARIABLE message OUTPUT_QUIET)
  if(NOT code EQUAL 2 OR NOT message MATCHES "built without the component ${component} ")
    message(FATAL_ERROR "${program} ${ARGN} ended with ${code}: ${message}")
  endif()
endfunction()
file(TOUCH ${WORK_DIR}/a.mp4 ${WORK_DIR}/a.mcap)
expect_fault(VIDEO mono_video a.mp4 --fov 60 --output out)
expect_fault(BAGS rgbd_bag a.mcap --output out)
expect_fault(BAGS stereo_bag a.mcap --output out)
expect_fault(BAGS rgbd_tum desk --mcap out.mcap --output out)
expect_fault(LIVE rgbd_tum desk --report --output out)
expect_fault(EXPORTS hullslam export out --to ply --output out.ply)
expect_fault(SCENE hullslam query out "cup")
expect_fault(SEGMENTATION hullslam segment desk --network a.onnx --output masks)

# The programs work: they render a short sequence, map its objects and write the results.
run(${BUILD_DIR}-none/bin/make_synthetic ${WORK_DIR}/desk --frames 10 --quiet)
run(${BUILD_DIR}-none/bin/rgbd_tum ${WORK_DIR}/desk --masks ${WORK_DIR}/desk/masks
    --output ${WORK_DIR}/out --quiet)
expect_fault(LIVE rgbd_tum desk --view 0 --output out2)
expect_fault(LIVE hullslam view out)
if(EXISTS ${WORK_DIR}/out2 OR EXISTS ${WORK_DIR}/out.ply OR NOT EXISTS ${WORK_DIR}/out/scene.json)
  message(FATAL_ERROR "the output is not as it should be")
endif()
file(REMOVE_RECURSE ${BUILD_DIR}-core ${BUILD_DIR}-none)
