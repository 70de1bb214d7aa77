# A build from nothing spends most of its time on the headers of Eigen, OpenCV and ROS, and on their templates. Two
# measures, each can be turned off; sources include what they need, and compile without either.
option(OBJECT_MODELLING_PRECOMPILE_HEADERS "Compile the headers of large libraries once" ON)
# Templates that several files use are then worked through once. A change of one file compiles its batch again.
option(OBJECT_MODELLING_UNITY_BUILD "Compile the files of a library in batches" OFF)
set(OBJECT_MODELLING_UNITY_BATCH_SIZE 8 CACHE STRING "Files of a batch of a unity build")
if(CMAKE_VERSION VERSION_LESS 3.16)
  set(OBJECT_MODELLING_PRECOMPILE_HEADERS OFF)
endif()

set(_object_modelling_std_headers
  <algorithm> <array> <chrono> <cmath> <cstdint> <fstream> <functional> <iomanip> <limits> <map> <memory> <mutex> <numeric>
  <optional> <set> <sstream> <string> <thread> <unordered_map> <utility> <vector>)
set(_object_modelling_image_headers <Eigen/Dense> <opencv2/core.hpp> <opencv2/imgproc.hpp>)
set(_object_modelling_ros_headers <ros/ros.h> <sensor_msgs/Image.h> <geometry_msgs/PoseStamped.h>)

# A target whose precompiled headers others use. A compiler takes them where its options are the same: position
# independent code, and OpenMP or not.
function(_object_modelling_precompiled_host name)
  cmake_parse_arguments(_arg "" "" "HEADERS;LINK" ${ARGN})
  set(_target object_modelling_precompiled_${name})
  set(_source ${CMAKE_BINARY_DIR}/precompiled/${name}.cpp)
  if(NOT EXISTS ${_source})
    file(WRITE ${_source} "// Only the precompiled headers of this target are wanted.\n")
  endif()
  add_library(${_target} STATIC EXCLUDE_FROM_ALL ${_source})
  set_target_properties(${_target} PROPERTIES POSITION_INDEPENDENT_CODE ON)
  target_link_libraries(${_target} PRIVATE ${_arg_LINK})
  target_precompile_headers(${_target} PRIVATE ${_object_modelling_std_headers} ${_object_modelling_image_headers} ${_arg_HEADERS})
endfunction()

if(OBJECT_MODELLING_PRECOMPILE_HEADERS)
  _object_modelling_precompiled_host(images LINK object_modelling_eigen object_modelling_opencv)
  _object_modelling_precompiled_host(images_openmp LINK object_modelling_eigen object_modelling_opencv object_modelling_openmp)
  _object_modelling_precompiled_host(ros LINK object_modelling_eigen object_modelling_opencv object_modelling_catkin
    HEADERS ${_object_modelling_ros_headers})
  if(CATKIN_ENABLE_TESTING)
    _object_modelling_precompiled_host(tests LINK object_modelling_eigen object_modelling_opencv ${GTEST_LIBRARIES} HEADERS <gtest/gtest.h>)
  endif()
endif()

# object_modelling_build_fast(<target> <images|images_openmp|ros|tests>): both measures, with the headers of that name.
function(object_modelling_build_fast target name)
  if(OBJECT_MODELLING_PRECOMPILE_HEADERS)
    target_compile_options(${target} PRIVATE -fPIC)
    target_precompile_headers(${target} REUSE_FROM object_modelling_precompiled_${name})
    # Options that differ cost time then, and no more.
    target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-error=invalid-pch>)
  endif()
  if(OBJECT_MODELLING_UNITY_BUILD)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${OBJECT_MODELLING_UNITY_BATCH_SIZE})
    # Of a batch GCC takes what is in an anonymous namespace for something that several files include.
    target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
  endif()
  if(OBJECT_MODELLING_PRECOMPILE_HEADERS OR OBJECT_MODELLING_UNITY_BUILD)
    # GCC 12 then takes the buffer of an empty boost::function for uninitialised, and warns within Boost; of ROS's own
    # functions GCC 14 is sure.
    target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
    if(name STREQUAL "ros")
      target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-uninitialized>)
    endif()
  endif()
endfunction()

# _object_modelling_links_openmp(<result> <what a target links>...): PCL of Debian 13 brings OpenMP along.
function(_object_modelling_links_openmp result)
  set(_pending ${ARGN})
  set(_seen)
  set(${result} FALSE PARENT_SCOPE)
  while(_pending)
    list(GET _pending 0 _item)
    list(REMOVE_AT _pending 0)
    if(_item STREQUAL "OpenMP::OpenMP_CXX")
      set(${result} TRUE PARENT_SCOPE)
      return()
    endif()
    if(TARGET "${_item}" AND NOT _item IN_LIST _seen)
      list(APPEND _seen ${_item})
      get_target_property(_links ${_item} INTERFACE_LINK_LIBRARIES)
      if(_links)
        list(APPEND _pending ${_links})
      endif()
    endif()
  endwhile()
endfunction()

# object_modelling_build_fast_by_links(<target> <what it links>...)
function(object_modelling_build_fast_by_links target)
  set(_name images)
  _object_modelling_links_openmp(_openmp ${ARGN})
  if(_openmp)
    set(_name images_openmp)
  elseif(ARGN MATCHES "object_modelling_(catkin|ros_bridge|node_common|[a-z_]*_nodes?)(;|$)")
    set(_name ros)
  endif()
  object_modelling_build_fast(${target} ${_name})
endfunction()
